"""Writes what the module has of the program: results.py from the guide's page on JSON, _commands.py from the command line.

``python tests/generate.py`` writes them anew; a test compares.
"""

import keyword
import re
import textwrap
from pathlib import Path

from slipfit import _slipfit

ROOT = Path(__file__).parent.parent
PAGE = ROOT.parent / "guide" / "src" / "json.md"
#: Result classes whose heading says less than a name has to, and those of commands whose name is no noun.
NAMES = {
    "beside": "ControllerComparison",
    "closing": "ClosingLevel",
    "controller of a mechanism": "MechanismController",
    "given": "StatedGap",
    "lack of fit": "LackOfFit",
    "part of malfunction": "PartOfMalfunction",
    "distribution of parts": "DistributionOfParts",
    "mean of units": "MeanOfUnits",
    "A shard of `tolerance` or `population`": "Shard",
}
CLASSES = {"simulate": "Simulation", "allocate": "Allocation", "identify": "Identification", "run": "Report"}
PLAIN = {"number": "float", "count": "int", "text": "str", "bool": "bool", "any": "Any"}
#: Columns beside the fields of JSON.
COLUMNS = {
    "simulate": ("columns", "the motion, a row every `every`, as `csv` writes it"),
    "sweep": ("columns", "figures of each level or value, as `csv` writes it"),
    "population": ("columns", "a row for each unit, as `csv` writes it; if they were asked for"),
    "tolerance": ("draws", "the measures of each unit; if they were asked for"),
}
#: What Scene has by hand, or as a function of another name.
BY_HAND = {"identify", "import", "schema", "watch"}
#: Options that the module passes itself.
OWN = {"scene", "set", "json", "help", "version"}


def tables(page: str) -> dict[str, list[tuple[str, str, str]]]:
    """Field, type and meaning of each table, by its heading."""
    found: dict[str, list[tuple[str, str, str]]] = {}
    heading = ""
    for line in page.splitlines():
        if line.startswith("##"):
            heading = line.lstrip("#").strip()
        elif line.startswith("| ") and not line.startswith("| field |"):
            cells = [cell.strip() for cell in line.strip("|").split(" | ")]
            if len(cells) == 3:
                found.setdefault(heading, []).append((cells[0], cells[1], cells[2].rstrip(" |")))
    # What is before the first heading says what the types mean.
    return {name: rows for name, rows in found.items() if name}


def class_name(heading: str) -> str:
    command = heading.strip("`") if heading.startswith("`") else None
    if command is not None:
        return CLASSES.get(command, command.capitalize())
    if heading in NAMES:
        return NAMES[heading]
    return "".join(word.capitalize() for word in re.findall(r"[A-Za-z]+", heading) if word not in ("of", "the"))


def type_of(kind: str) -> str:
    kind = kind.strip()
    if kind.startswith("(") and kind.endswith(")"):
        return type_of(kind[1:-1])
    if kind.endswith((" optional", " or null")):
        of = type_of(kind.removesuffix(" optional").removesuffix(" or null"))
        return of if of.endswith(" | None") or of == "Any" else f"{of} | None"
    if kind.startswith("list of "):
        return f"list[{type_of(kind[8:])}]"
    if kind.startswith("map of "):
        return f"dict[str, {type_of(kind[7:])}]"
    return PLAIN.get(kind) or class_name(kind)


def flat(all_tables, name):
    """The fields of a table, those of ``*`` among them."""
    for field, kind, meaning in all_tables[name]:
        if field == "*":
            yield from flat(all_tables, next(one for one in all_tables if one.strip("`") == kind))
        else:
            yield field, kind, meaning


def results() -> str:
    """results.py."""
    all_tables = tables(PAGE.read_text("utf-8"))
    classes: dict[str, list[dict[str, tuple[str, str]]]] = {}
    about: dict[str, str] = {}
    for heading in all_tables:
        command = re.match(r"`(\w+)", heading)
        name = class_name(f"`{command[1]}`" if command else heading)
        about.setdefault(name, f"What ``{command[1]}`` finds." if command else f"{heading[0].upper()}{heading[1:]}.")
        fields = {field: (type_of(kind), meaning) for field, kind, meaning in flat(all_tables, heading)}
        if command and (column := COLUMNS.get(command[1])):
            if command[1] == "simulate":
                # They are the columns.
                fields = {field: one for field, one in fields.items() if field not in ("columns", "samples")}
            fields[column[0]] = ("Columns" if command[1] in ("simulate", "sweep") else "Columns | None", column[1])
        # Warnings that the command line has on standard error alone are here, too.
        if "json_version" in fields:
            fields.setdefault("warnings", ("list[str]", "what to know before trusting the result"))
        classes.setdefault(name, []).append(fields)
    lines = [
        '"""Results of commands and what they are made of. Generated from the guide\'s page on JSON, which says more.',
        "",
        "A field that is missing where a scene is of another kind, or an option was not given, is None as an attribute.",
        '"""',
        "",
        "from __future__ import annotations",
        "",
        "from typing import Any",
        "",
        "from slipfit._result import Result",
        "from slipfit._slipfit import Columns",
    ]
    # Not what are columns here, nor what is part of other tables alone.
    named = {word for forms in classes.values() for form in forms for kind, _ in form.values() for word in re.findall(r"\w+", kind)}
    classes = {name: forms for name, forms in classes.items() if name in named or "json_version" in forms[0]}
    for name, forms in classes.items():
        lines += ["", "", f"class {name}(Result):", f'    """{about[name]}"""']
        fields: dict[str, tuple[list[str], str]] = {}
        for form in forms:
            for field, (kind, meaning) in form.items():
                kinds, _ = fields.setdefault(field, ([], meaning))
                kinds += [one for one in kind.split(" | ") if one not in kinds]
        for field, (kinds, meaning) in fields.items():
            if any(field not in form for form in forms) and "None" not in kinds:
                kinds.append("None")
            kinds.sort(key=lambda kind: kind == "None")
            text = keyword_of(re.sub(r"\bnull\b", "None", meaning.replace("\\", ""))).replace("`", "``")
            if re.search(r"\]\(", text):
                text = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", text)
            lines += [*textwrap.wrap(f"    #: {text[0].upper()}{text[1:]}.", 118, subsequent_indent="    #: ")]
            lines.append(f"    {python_name(field)}: {' | '.join(kinds)}")
    return "\n".join(lines) + "\n"


def commands() -> str:
    """_commands.py."""
    lines = [
        '"""Commands as functions. Generated from the command line.',
        "",
        "A keyword is the option of that name. Options that are None are left out. Every function has these keywords, too:",
        "",
        "progress: a function of what is done, how much, and of how much; or whether a line on standard error shows it. Without it a line",
        "    is shown where standard error is a terminal.",
        "picture: whether the result has the pictures of ``plot`` in ``pictures``. Without it, it has them in notebooks.",
        '"""',
        "",
        "from __future__ import annotations",
        "",
        "from collections.abc import Mapping, Sequence",
        "from typing import Any, overload",
        "",
        "from slipfit import results",
        "from slipfit._call import Files, Option, Paths, Table, call, paths_of",
        "from slipfit._progress import Progress",
    ]
    of_scene, others = [], []
    for name, about, options in _slipfit.commands():
        if name in BY_HAND or name == "help":
            continue
        of_scene_here = any(place and option == "scene" for option, *_, place in options)
        (of_scene if of_scene_here else others).append(function(name, about, options, of_scene_here))
    lines += ["", "", "class SceneCommands:", '    """The commands that work on a scene."""', ""]
    lines += [
        "    def _call(",
        "        self, kind: Any, command: str, options: Mapping[str, Option], others: Sequence[Table] = (), **wanted: Any",
        "    ) -> Any:",
        "        raise NotImplementedError",
    ]
    return "\n".join([*lines, *sum(of_scene, []), *sum(others, [])]) + "\n"


def function(name: str, about: str, options, of_scene: bool) -> list[str]:
    """The lines of a function."""
    indent = "    " if of_scene else ""
    arguments = [one for one in options if one[0] not in OWN]
    places = [one for one in arguments if one[4]]
    keywords = [one for one in arguments if not one[4]]
    kind = CLASSES.get(name, name.capitalize())
    result = "results.Population | results.Tolerance" if name == "merge" else f"results.{kind}"
    whole = result
    if shards := "shard" in [option for option, *_ in keywords]:
        result += " | results.Shard"
    column = COLUMNS.get(name)
    has_picture = any(option in ("plot", "plots") for option, *_ in keywords)
    asked = column is not None and name not in ("simulate", "sweep")
    shown = [one for one in keywords if not is_column(column, asked, one[0])]
    signature = ["self"] if of_scene else []
    signature += [f"{python_name(option)}: {'Paths' if many else 'Table'}" for option, _, _, many, _ in places]
    signature.append("*")
    signature += [f"{python_name(option)}: {option_type(value)}" for option, value, *_ in shown]
    signature += [f"{column[0]}: bool = False"] if asked else []
    signature += ["picture: bool | None = None"] if has_picture else []
    signature.append("progress: Progress = None")
    lines = ["", *([] if of_scene else [""])]
    for shard, returned in [("None = None", whole), ("str", result)] if shards else []:
        overloaded = [f"shard: {shard}" if one.startswith("shard: ") else one for one in signature]
        lines += [f"{indent}@overload", f"{indent}def {name}("]
        lines += [f"{indent}    {one}," for one in overloaded] + [f"{indent}) -> {returned}: ..."]
    lines.append(f"{indent}def {name}(")
    lines += [f"{indent}    {one}," for one in signature] + [f"{indent}) -> {result}:"]
    lines += docstring(about, [*places, *shown], column if asked else None, has_picture, of_scene, indent + "    ")
    passed = ", ".join(f'"{option.replace("-", "_")}": {python_name(option)}' for option, *_ in shown)
    wanted = []
    if column is not None:
        wanted.append(f"{column[0]}={column[0] if asked else True}")
    wanted += ["picture=picture"] if has_picture else []
    wanted.append("progress=progress")
    inner = indent + "    "
    lines.append(f"{inner}options: dict[str, Option] = {{{passed}}}")
    if of_scene:
        lines.append(f'{inner}found: {result} = self._call({result}, "{name}", options, {", ".join(wanted)})')
    elif places and places[0][3]:
        lines.append(f"{inner}paths = paths_of({python_name(places[0][0])})")
        lines.append(f'{inner}found: {result} = call({result}, "{name}", paths, options, {", ".join(wanted)})')
    else:
        lines.append(f"{inner}with Files() as files:")
        lines.append(f"{inner}    path = files.of({python_name(places[0][0])})")
        lines.append(f'{inner}    found: {result} = call({result}, "{name}", [path], options, {", ".join(wanted)})')
    return [*lines, f"{inner}return found"]


def is_column(column, asked: bool, option: str) -> bool:
    """Whether the option asks for a file of the columns that a keyword of this name asks for."""
    return asked and column is not None and column[0] == option


def python_name(option: str) -> str:
    name = option.replace("-", "_")
    return f"{name}_" if keyword.iskeyword(name) else name


def option_type(value: str | None) -> str:
    return "bool = False" if value is None else "Option = None"


def keyword_of(text: str) -> str:
    """Help of the command line, in which options are keywords and repeated ones lists."""
    text = re.sub(r"`(\w+) --([a-z]+(?:-[a-z]+)*)`", lambda option: f"`{option[1]}` with `{option[2].replace('-', '_')}`", text)
    text = re.sub(r"`?--([a-z]+(?:-[a-z]+)*)`?", lambda option: f"`{option[1].replace('-', '_')}`", text)
    return text.replace("; may be repeated", "; or a list of them")


def docstring(about: str, arguments, column, has_picture: bool, of_scene: bool, indent: str) -> list[str]:
    first, *rest = keyword_of(about).split("\n\n")
    text = [first.replace("\n", " ").strip()]
    for paragraph in rest:
        text += ["", paragraph.replace("\n", " ").strip()]
    text += ["", "Args:"]
    for option, value, help_text, *_ in arguments:
        name = python_name(option)
        text.append(f"    {name}: {keyword_of(' '.join(help_text.split())).rstrip('.')}.")
    text += [f"    {column[0]}: Whether the result has {column[1].split(';')[0]}."] if column else []
    text += ["    picture: Whether the result has pictures; if None, in notebooks."] if has_picture else []
    text += ["    progress: A function, or whether a line on standard error says how far it is.", "", "Raises:"]
    text += ["    SceneError: A mistake in the scene, with file, line, column and what is allowed."] if of_scene else []
    text += [
        "    InputError: Another argument that is not allowed.",
        "    WorkError: Valid input without a result, such as a full disk.",
    ]
    lines: list[str] = []
    for line in text:
        hanging = "        " if line.startswith("    ") else ""
        wrapped = textwrap.wrap(line, 118, initial_indent=indent, subsequent_indent=indent + hanging, break_long_words=False)
        lines += wrapped or [""]
    lines[0] = f'{indent}"""{lines[0].strip()}'
    return [*lines, f'{indent}"""']


FILES = {ROOT / "python" / "slipfit" / "results.py": results, ROOT / "python" / "slipfit" / "_commands.py": commands}

if __name__ == "__main__":
    for path, text in FILES.items():
        path.write_text(text(), "utf-8")
