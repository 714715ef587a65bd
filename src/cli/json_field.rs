//! A value of a JSON document and where it stands, so that every complaint names its field.

use serde_json::Value;

use crate::geometry::Vec3;

/// A JSON value and its path from the document's root.
#[derive(Clone, Debug)]
pub struct Field<'a> {
    /// The value.
    pub value: &'a Value,
    /// For example `a.params.half_extents[2]`; empty for the root.
    pub path: String,
}

/// A field is not what it should be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{path}: {problem}")]
pub struct FieldError {
    /// Where.
    pub path: String,
    /// What is wrong there.
    pub problem: String,
}

type Found<T> = Result<T, FieldError>;

impl<'a> Field<'a> {
    /// The whole document.
    #[must_use]
    pub fn root(value: &'a Value) -> Self {
        Self { value, path: String::new() }
    }

    /// A complaint about this field.
    #[must_use]
    pub fn error(&self, problem: impl ToString) -> FieldError {
        let path = if self.path.is_empty() { "line".to_owned() } else { self.path.clone() };
        FieldError { path, problem: problem.to_string() }
    }

    /// The member `name`.
    ///
    /// # Errors
    /// This is no object, or has no such member.
    pub fn member(&self, name: &str) -> Found<Field<'a>> {
        let members = self.value.as_object().ok_or_else(|| self.error(not("an object", self.value)))?;
        let path = if self.path.is_empty() { name.to_owned() } else { format!("{}.{name}", self.path) };
        match members.get(name) {
            Some(value) => Ok(Field { value, path }),
            None => Err(FieldError { path, problem: "is missing".to_owned() }),
        }
    }

    /// The member `name`, if there is one and it is not null.
    #[must_use]
    pub fn optional(&self, name: &str) -> Option<Field<'a>> {
        self.member(name).ok().filter(|field| !field.value.is_null())
    }

    /// The elements of a list.
    ///
    /// # Errors
    /// This is no list.
    pub fn elements(&self) -> Found<Vec<Field<'a>>> {
        let list = self.value.as_array().ok_or_else(|| self.error(not("a list", self.value)))?;
        let element = |(i, value)| Field { value, path: format!("{}[{i}]", self.path) };
        Ok(list.iter().enumerate().map(element).collect())
    }

    /// Exactly `N` elements.
    ///
    /// # Errors
    /// This is no list, or has another length.
    pub fn exactly<const N: usize>(&self) -> Found<[Field<'a>; N]> {
        let elements = self.elements()?;
        let count = elements.len();
        elements.try_into().map_err(|_| self.error(format!("has {count} elements, {N} are needed")))
    }

    /// A number.
    ///
    /// # Errors
    /// This is no number.
    pub fn number(&self) -> Found<f64> {
        self.value.as_f64().ok_or_else(|| self.error(not("a number", self.value)))
    }

    /// A whole number from zero that fits `T`.
    ///
    /// # Errors
    /// This is no such number.
    pub fn index<T: TryFrom<u64>>(&self) -> Found<T> {
        let whole = self.value.as_u64().and_then(|n| T::try_from(n).ok());
        whole.ok_or_else(|| self.error(not("an index", self.value)))
    }

    /// A whole number of either sign that fits `i32`.
    ///
    /// # Errors
    /// This is no such number.
    pub fn integer(&self) -> Found<i32> {
        let whole = self.value.as_i64().and_then(|n| i32::try_from(n).ok());
        whole.ok_or_else(|| self.error(not("a whole number", self.value)))
    }

    /// A text.
    ///
    /// # Errors
    /// This is no text.
    pub fn text(&self) -> Found<&'a str> {
        self.value.as_str().ok_or_else(|| self.error(not("a text", self.value)))
    }

    /// True or false.
    ///
    /// # Errors
    /// This is neither.
    pub fn boolean(&self) -> Found<bool> {
        self.value.as_bool().ok_or_else(|| self.error(not("true or false", self.value)))
    }

    /// Three numbers.
    ///
    /// # Errors
    /// This is no list of three numbers.
    pub fn vector(&self) -> Found<Vec3> {
        let [x, y, z] = self.exactly()?;
        Ok(Vec3::new(x.number()?, y.number()?, z.number()?))
    }

    /// A list of numbers.
    ///
    /// # Errors
    /// This is no list of numbers.
    pub fn numbers(&self) -> Found<Vec<f64>> {
        self.elements()?.iter().map(Field::number).collect()
    }

    /// A list of triples of numbers.
    ///
    /// # Errors
    /// This is no such list.
    pub fn vectors(&self) -> Found<Vec<Vec3>> {
        self.elements()?.iter().map(Field::vector).collect()
    }

    /// Refuses members that nobody reads: most are misspelt names of ones that are.
    ///
    /// # Errors
    /// A member that is not in `known`.
    pub fn only(&self, known: &[&str]) -> Found<()> {
        let members = self.value.as_object().ok_or_else(|| self.error(not("an object", self.value)))?;
        match members.keys().find(|name| !known.contains(&name.as_str())) {
            Some(name) => Err(self.error(format!("has a member {name:?}; known are: {}", known.join(", ")))),
            None => Ok(()),
        }
    }
}

fn not(wanted: &str, value: &Value) -> String {
    let kind = match value {
        Value::Null => "null",
        Value::Bool(_) => "a truth value",
        Value::Number(_) => "another number",
        Value::String(_) => "a text",
        Value::Array(_) => "a list",
        Value::Object(_) => "an object",
    };
    format!("is {kind}, not {wanted}")
}
