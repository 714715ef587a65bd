//! Which field of a request is it? Built on the stack while decoding, written out only when something is wrong.

use std::fmt;

use crate::service::ServiceError;

/// A field and where it is, for example `items[3].shape.box.half_extents`.
#[derive(Clone, Copy, Debug)]
pub struct Path<'a> {
    parent: Option<&'a Path<'a>>,
    name: &'static str,
    index: Option<usize>,
}

impl<'a> Path<'a> {
    /// A field of the request itself.
    #[must_use]
    pub fn root(name: &'static str) -> Self {
        Self { parent: None, name, index: None }
    }

    /// An entry of a repeated field of the request itself.
    #[must_use]
    pub fn root_item(name: &'static str, index: usize) -> Self {
        Self { parent: None, name, index: Some(index) }
    }

    /// A field of this field.
    #[must_use]
    pub fn field(&'a self, name: &'static str) -> Self {
        Self { parent: Some(self), name, index: None }
    }

    /// An entry of a repeated field of this field.
    #[must_use]
    pub fn item(&'a self, name: &'static str, index: usize) -> Self {
        Self { parent: Some(self), name, index: Some(index) }
    }

    /// This field cannot be as it is.
    pub fn invalid(&self, problem: impl ToString) -> ServiceError {
        ServiceError::invalid(self.to_string(), problem)
    }

    /// What is in a field that must be said.
    ///
    /// # Errors
    /// It is not.
    pub fn required<T>(&self, value: Option<T>) -> Result<T, ServiceError> {
        value.ok_or_else(|| self.invalid("is missing"))
    }
}

impl fmt::Display for Path<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(parent) = self.parent {
            write!(f, "{parent}.")?;
        }
        f.write_str(self.name)?;
        self.index.map_or(Ok(()), |index| write!(f, "[{index}]"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_reads_as_in_a_program() {
        let item = Path::root_item("items", 3);
        let shape = item.field("shape");
        let part = shape.item("parts", 0);
        assert_eq!(part.field("pose").to_string(), "items[3].shape.parts[0].pose");
    }
}
