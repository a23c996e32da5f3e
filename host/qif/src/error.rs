//! What is wrong with a file.

/// A file that cannot be read, with the place of the fault.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{line}:{column}: {problem}")]
pub struct QifError {
    /// Line, from 1.
    pub line: u32,
    /// Column in characters, from 1.
    pub column: u32,
    /// What is wrong there.
    pub problem: Problem,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Problem {
    /// Not well-formed XML.
    #[error("not well-formed XML: {0}")]
    Malformed(String),
    /// A document type declaration, which could define entities that expand.
    #[error("a document type declaration: QIF has none, and its entities are not expanded")]
    DocumentType,
    /// Elements nested too deeply.
    #[error("elements are nested more than {0} deep")]
    Nesting(usize),
    /// An element with too many attributes.
    #[error("an element with more than {0} attributes")]
    Attributes(usize),
    /// More elements than a QIF file of this length has.
    #[error("more than {0} elements and texts in a file of this length")]
    Nodes(u32),
    /// Another XML format.
    #[error("the root element is `{0}`, not `QIFDocument`")]
    Root(String),
    /// An element that must be there.
    #[error("`{element}` has no `{missing}`")]
    Missing {
        /// The element.
        element: String,
        /// What it lacks.
        missing: String,
    },
    /// A text that is no finite number.
    #[error("`{0}` is not a finite number")]
    Number(String),
    /// A reference to an element that the file does not have.
    #[error("`{element}` refers to {id}, which the file does not have")]
    Reference {
        /// The element.
        element: String,
        /// The id.
        id: String,
    },
    /// A unit that the file does not declare.
    #[error("the unit `{0}` is not declared in FileUnits")]
    Unit(String),
    /// Features of several parts, each in a frame of its own.
    #[error("features of {0} parts in one file; export each part as a file of its own")]
    Parts(usize),
    /// A file without what was asked for.
    #[error("no {0} in the file")]
    Nothing(&'static str),
    /// Values that contradict each other.
    #[error("{0}")]
    Table(String),
}
