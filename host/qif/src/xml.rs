//! The tree of a file, within limits that are checked before it is built.

use roxmltree::{Document, Node, ParsingOptions};

use crate::error::{Problem, QifError};

/// Deepest nesting of elements; QIF files have about 20 levels.
const DEEPEST: usize = 128;
/// Most attributes of an element; QIF elements have up to about 10.
const MOST_ATTRIBUTES: usize = 128;
/// Least length of a file (bytes) for each node of its tree, so that the tree takes at most a fixed multiple of the file.
/// QIF files have one node for 15 bytes or more.
const LEAST_PER_NODE: usize = 6;
/// Nodes that any file may have.
const ALWAYS_ALLOWED: usize = 10_000;

/// Parses `text`.
///
/// # Errors
/// Text that is not well-formed XML or exceeds a limit.
pub fn parse(text: &str) -> Result<Document<'_>, QifError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    check_limits(text)?;
    let most = u32::try_from(ALWAYS_ALLOWED.max(text.len() / LEAST_PER_NODE)).unwrap_or(u32::MAX);
    let options = ParsingOptions { allow_dtd: false, nodes_limit: most, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        use roxmltree::Error;
        let at_end = matches!(error, Error::UnclosedRootNode | Error::UnexpectedEndOfStream | Error::NoRootNode);
        let problem = match &error {
            Error::DtdDetected => Problem::DocumentType,
            Error::NodesLimitReached => Problem::Nodes(most),
            _ => Problem::Malformed(without_place(&error.to_string())),
        };
        if at_end {
            return at(text, text.len(), problem);
        }
        let place = error.pos();
        QifError { line: place.row, column: place.col, problem }
    })
}

/// The message of an XML error without the place that [`QifError`] shows already.
fn without_place(message: &str) -> String {
    match message.rfind(" at ") {
        Some(at) if message[at + 4..].chars().all(|c| c.is_ascii_digit() || c == ':') => message[..at].to_owned(),
        _ => message.to_owned(),
    }
}

/// An error at a byte of the text.
fn at(text: &str, byte: usize, problem: Problem) -> QifError {
    let before = text.get(..byte).unwrap_or(text);
    let line = before.matches('\n').count() + 1;
    let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
    let limited = |count: usize| u32::try_from(count).unwrap_or(u32::MAX);
    QifError { line: limited(line), column: limited(column), problem }
}

/// Refuses deep nesting, many attributes and document types in one pass over the tags, whose syntax the parser checks.
fn check_limits(text: &str) -> Result<(), QifError> {
    let mut depth = 0_usize;
    let mut from = 0;
    while let Some(start) = text[from..].find('<').map(|at| from + at) {
        let tag = &text[start..];
        let skipped = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((_, end)) = skipped.iter().find(|(begin, _)| tag.starts_with(begin)) {
            // The parser tells of what is not closed.
            let Some(end) = tag.find(end).map(|at| start + at + end.len()) else { return Ok(()) };
            from = end;
            continue;
        }
        if tag.starts_with("<!") {
            return Err(at(text, start, Problem::DocumentType));
        }
        let (mut quote, mut attributes, mut end) = (None, 0, None);
        for (i, byte) in tag.bytes().enumerate() {
            match (quote, byte) {
                (Some(open), _) if open == byte => quote = None,
                (Some(_), _) => {}
                (None, b'"' | b'\'') => quote = Some(byte),
                (None, b'=') => attributes += 1,
                (None, b'>') => {
                    end = Some(i);
                    break;
                }
                _ => {}
            }
            if attributes > MOST_ATTRIBUTES {
                return Err(at(text, start, Problem::Attributes(MOST_ATTRIBUTES)));
            }
        }
        let Some(end) = end else { return Ok(()) };
        if tag.starts_with("</") {
            depth = depth.saturating_sub(1);
        } else if !tag[..end].ends_with('/') {
            depth += 1;
        }
        if depth > DEEPEST {
            return Err(at(text, start, Problem::Nesting(DEEPEST)));
        }
        from = start + end + 1;
    }
    Ok(())
}

/// An error at an element.
pub fn error_at(node: Node, problem: Problem) -> QifError {
    let place = node.document().text_pos_at(node.range().start);
    QifError { line: place.row, column: place.col, problem }
}

/// Name of an element without its namespace.
pub fn name<'a>(node: Node<'a, '_>) -> &'a str {
    node.tag_name().name()
}

/// Child elements.
pub fn children<'a, 'i>(node: Node<'a, 'i>) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(Node::is_element)
}

/// First child element of a name.
pub fn child<'a, 'i>(node: Node<'a, 'i>, wanted: &str) -> Option<Node<'a, 'i>> {
    children(node).find(|child| name(*child) == wanted)
}

/// Descendant by a path of names.
pub fn path<'a, 'i>(node: Node<'a, 'i>, names: &[&str]) -> Option<Node<'a, 'i>> {
    names.iter().try_fold(node, |node, name| child(node, name))
}

/// Text of an element, trimmed.
pub fn text<'a>(node: Node<'a, '_>) -> &'a str {
    node.text().unwrap_or_default().trim()
}

/// Text of a child element, if it has any.
pub fn text_of<'a>(node: Node<'a, '_>, wanted: &str) -> Option<&'a str> {
    child(node, wanted).map(text).filter(|text| !text.is_empty())
}

/// Whether a child element says `true`.
pub fn is_true(node: Node, wanted: &str) -> bool {
    matches!(text_of(node, wanted), Some("true" | "1"))
}

/// The child element of a name, which must be there.
pub fn require<'a, 'i>(node: Node<'a, 'i>, wanted: &str) -> Result<Node<'a, 'i>, QifError> {
    child(node, wanted)
        .ok_or_else(|| error_at(node, Problem::Missing { element: name(node).to_owned(), missing: wanted.to_owned() }))
}

/// The finite number that an element holds (xs:decimal).
pub fn number(node: Node) -> Result<f64, QifError> {
    numbers(node)?.first().copied().ok_or_else(|| error_at(node, Problem::Number(String::new())))
}

/// The finite numbers that an element holds, separated by spaces.
pub fn numbers(node: Node) -> Result<Vec<f64>, QifError> {
    let read = |word: &str| word.parse().ok().filter(|value: &f64| value.is_finite());
    let wrong = |word: &str| error_at(node, Problem::Number(word.chars().take(40).collect()));
    text(node).split_whitespace().map(|word| read(word).ok_or_else(|| wrong(word))).collect()
}

/// The three numbers that an element holds (PointType, UnitVectorType).
pub fn triple(node: Node) -> Result<[f64; 3], QifError> {
    let found = numbers(node)?;
    <[f64; 3]>::try_from(found).map_err(|_| error_at(node, Problem::Number(text(node).chars().take(40).collect())))
}

/// The ids of a list of references (ArrayReferenceFullType).
pub fn ids<'a>(node: Node<'a, '_>, list: &str) -> Vec<&'a str> {
    child(node, list).map(|list| children(list).map(text).collect()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::{Problem, parse};

    fn fault(text: &str) -> (u32, u32, Problem) {
        let error = parse(text).expect_err("an error");
        (error.line, error.column, error.problem)
    }

    #[test]
    fn deep_nesting_is_refused_at_its_place() {
        let deep = "<a>\n".repeat(1_000_000);
        assert_eq!(fault(&deep), (129, 1, Problem::Nesting(128)));
    }

    #[test]
    fn entities_are_refused() {
        let bomb = "<?xml version=\"1.0\"?>\n<!DOCTYPE a [<!ENTITY b \"bbbb\"><!ENTITY c \"&b;&b;\">]>\n<a>&c;</a>";
        assert_eq!(fault(bomb), (2, 1, Problem::DocumentType));
        assert!(matches!(fault("<a>&c;</a>"), (1, 4, Problem::Malformed(_))));
    }

    #[test]
    fn many_nodes_and_attributes_are_refused() {
        let many = format!("<a>{}</a>", "<b/>".repeat(200_000));
        assert!(matches!(fault(&many), (_, _, Problem::Nodes(_))));
        let wide: String = (0..200).map(|i| format!(" b{i}=\"\"")).collect();
        assert_eq!(fault(&format!("<a>\n <b{wide}/></a>")), (2, 2, Problem::Attributes(128)));
    }

    #[test]
    fn faults_have_a_place() {
        assert!(matches!(fault("<a>\n  <b></c></a>"), (2, 6, Problem::Malformed(_))));
        assert!(matches!(fault("<a>\n <b>"), (2, 5, Problem::Malformed(_))));
        assert!(matches!(fault("<a b='"), (1, 7, Problem::Malformed(_))));
        assert!(matches!(fault(""), (1, 1, Problem::Malformed(_))));
        for text in ["<", "<!--", "<![CDATA[", "<?xml", "<a", "<a/", "é<"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }
}
