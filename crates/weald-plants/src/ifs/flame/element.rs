//! Elements of a flame file and the numbers in their attributes; faults name line, element and attribute.

use roxmltree::Node;

use weald_io::Fault;

/// An element, with what a fault says of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Element<'a>(Node<'a, 'a>);

impl<'a> Element<'a> {
    pub(super) fn of(node: Node<'a, 'a>) -> Self {
        Self(node)
    }

    pub(super) fn name(self) -> &'a str {
        self.0.tag_name().name()
    }

    /// The elements directly within.
    pub(super) fn children(self) -> impl Iterator<Item = Self> {
        self.0.children().filter(Node::is_element).map(Self)
    }

    /// Names and values of all attributes, in their order.
    pub(super) fn attributes(self) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.0.attributes().map(|attribute| (attribute.name(), attribute.value()))
    }

    pub(super) fn text(self, attribute: &str) -> Option<&'a str> {
        self.0.attribute(attribute)
    }

    /// What is wrong with this element.
    pub(super) fn fault(self, what: &str) -> Fault {
        let place = self.0.document().text_pos_at(self.0.range().start);
        Fault::damaged(format!("line {}, <{}>: {what}", place.row, self.name()))
    }

    /// A number, if the attribute is there.
    pub(super) fn number(self, attribute: &str) -> Result<Option<f64>, Fault> {
        let Some(text) = self.text(attribute) else { return Ok(None) };
        let number = finite(text.trim());
        let number = number
            .ok_or_else(|| self.fault(&format!("`{attribute}` is `{}`; it must be a number", shown(text))))?;
        Ok(Some(number))
    }

    /// All numbers of a list.
    pub(super) fn list(self, attribute: &str, text: &str) -> Result<Vec<f64>, Fault> {
        let number = |word: &str| {
            finite(word).ok_or_else(|| {
                self.fault(&format!("`{attribute}` has `{}` where a number must stand", shown(word)))
            })
        };
        text.split_ascii_whitespace().map(number).collect()
    }

    /// The six numbers of a map, if the attribute is there.
    pub(super) fn six(self, attribute: &str) -> Result<Option<[f64; 6]>, Fault> {
        let Some(text) = self.text(attribute) else { return Ok(None) };
        let numbers = self.list(attribute, text)?;
        let count = numbers.len();
        let six = numbers.try_into();
        six.map(Some).map_err(|_| self.fault(&format!("`{attribute}` has {count} numbers; it must have 6")))
    }
}

fn finite(word: &str) -> Option<f64> {
    word.parse().ok().filter(|number: &f64| number.is_finite())
}

/// As much of a value as a message has room for.
pub(super) fn shown(text: &str) -> String {
    const ROOM: usize = 40;
    let short: String = text.chars().take(ROOM).collect();
    if short.len() < text.len() { short + "…" } else { short }
}
