//! The README and the guide are short: sentences of at most 30 words, a README of at most 95 lines.

use std::path::{Path, PathBuf};

/// The most words of a sentence.
const MOST: usize = 30;

/// The README and all pages of the guide.
fn pages() -> Vec<PathBuf> {
    let host = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut pages = vec![host.join("../README.md")];
    for folder in ["guide/src", "guide/src/notes"] {
        let files = std::fs::read_dir(host.join(folder)).unwrap().map(|entry| entry.unwrap().path());
        pages.extend(files.filter(|path| path.extension().is_some_and(|ext| ext == "md")));
    }
    pages.sort();
    pages
}

/// `text` without what stands between each `open` and the next `close`: `instead` in its place.
fn without(text: &str, open: &str, close: &str, instead: &str) -> String {
    let mut kept = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once(open) {
        kept += before;
        kept += instead;
        rest = after.split_once(close).map_or("", |(_, after)| after);
    }
    kept + rest
}

/// The paragraphs and list items of a page: no code, tables, headings and pictures.
fn paragraphs(page: &str) -> Vec<String> {
    let mut paragraphs = vec![String::new()];
    for line in without(page, "```", "```", "\n\n").lines() {
        let text = line.trim_start();
        let numbered = text.split_once(". ").is_some_and(|(number, _)| number.parse::<u32>().is_ok());
        let ends = text.is_empty() || text.starts_with(['#', '|', '!']);
        if ends || numbered || text.starts_with(['-', '>']) {
            paragraphs.push(String::new());
        }
        if !ends {
            let last = paragraphs.last_mut().unwrap();
            *last += text.trim_start_matches(['-', '>']);
            last.push(' ');
        }
    }
    // A link is its text; code is a word.
    paragraphs.iter().map(|text| without(&without(text, "](", ")", ""), "`", "`", "X")).collect()
}

/// Whether a sentence ends between `word` and the `next` one.
fn ends(word: &str, next: &str) -> bool {
    let stopped = word.trim_end_matches([')', '*', '"', ']']).ends_with(['.', '?', '!']);
    stopped && (!next.starts_with(char::is_lowercase) || next.starts_with("slipfit"))
}

/// The sentences of a paragraph, as words.
fn sentences(paragraph: &str) -> Vec<Vec<&str>> {
    let mut sentences = vec![Vec::new()];
    let words: Vec<&str> = paragraph.split_whitespace().collect();
    for (i, word) in words.iter().enumerate() {
        if word.contains(char::is_alphanumeric) {
            sentences.last_mut().unwrap().push(*word);
        }
        if words.get(i + 1).is_some_and(|next| ends(word, next)) {
            sentences.push(Vec::new());
        }
    }
    sentences
}

#[test]
fn sentences_are_short() {
    let mut long = String::new();
    for page in pages() {
        let text = std::fs::read_to_string(&page).unwrap();
        for paragraph in paragraphs(&text) {
            for sentence in sentences(&paragraph).into_iter().filter(|sentence| sentence.len() > MOST) {
                let name = page.file_name().unwrap().to_str().unwrap();
                long += &format!("{name}, {} words: {}\n", sentence.len(), sentence.join(" "));
            }
        }
    }
    assert!(long.is_empty(), "{long}");
}

#[test]
fn the_readme_takes_two_minutes() {
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../README.md")).unwrap();
    assert!(text.lines().count() <= 95);
}

#[test]
fn words_are_counted_as_a_reader_does() {
    let page = "# A heading\n\nOne [two](three.md) `four five`. Next\none!\n\n```sh\nno words\n```\n| no | words |\n- A point (of a\n  list).\n";
    let counts: Vec<usize> =
        paragraphs(page).iter().flat_map(|text| sentences(text)).map(|words| words.len()).filter(|n| *n > 0).collect();
    assert_eq!(counts, [3, 2, 5]);
}
