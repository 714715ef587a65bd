//! Groups and declared effects of a scene file: what may be asked of which pairs.

use super::json_field::{Field, FieldError};
use crate::scene::{BodyRef, Effect, Effects, Party};

/// What a scene file declares of two parties.
#[derive(Clone, Debug, PartialEq)]
pub struct DeclaredPair {
    /// Both sides.
    pub between: [PartyName; 2],
    /// What may be asked of their pairs.
    pub effects: Effects,
}

/// A party as a scene file names it, where the robot has no name yet.
#[derive(Clone, Debug, PartialEq)]
pub enum PartyName {
    /// The robot that is asked about.
    Robot,
    /// A link of it.
    Link(String),
    /// An object.
    Object(String),
    /// All objects of a group.
    Group(String),
    /// Everything.
    Everything,
}

impl PartyName {
    /// Whom it means in a scene where the robot is called `robot`.
    #[must_use]
    pub fn in_scene(&self, robot: &str) -> Party {
        match self {
            Self::Robot => Party::Robot(robot.to_owned()),
            Self::Link(link) => Party::Link { robot: robot.to_owned(), link: link.clone() },
            Self::Object(name) => Party::Body(BodyRef::Name(name.clone())),
            Self::Group(name) => Party::Group(name.clone()),
            Self::Everything => Party::Everything,
        }
    }
}

/// Makes a party of its name.
type Named = fn(String) -> PartyName;

/// `[{between: [PARTY, PARTY], effects: [EFFECT, ..]}, ..]`; none where the member is missing.
pub(super) fn read_effects(effects: Option<&Field>) -> Result<Vec<DeclaredPair>, FieldError> {
    let Some(effects) = effects else { return Ok(Vec::new()) };
    effects.elements()?.iter().map(declared_pair).collect()
}

/// `[NAME, ..]`; none where the member is missing.
pub(super) fn read_groups(groups: Option<&Field>) -> Result<Vec<String>, FieldError> {
    let Some(groups) = groups else { return Ok(Vec::new()) };
    groups.elements()?.iter().map(|group| group.text().map(str::to_owned)).collect()
}

fn declared_pair(declared: &Field) -> Result<DeclaredPair, FieldError> {
    declared.only(&["between", "effects"])?;
    let [a, b] = declared.member("between")?.exactly()?;
    let effects = declared.member("effects")?.elements()?;
    let effects: Vec<Effect> = effects.iter().map(effect).collect::<Result<_, _>>()?;
    Ok(DeclaredPair { between: [party(&a)?, party(&b)?], effects: effects.into_iter().collect() })
}

fn party(field: &Field) -> Result<PartyName, FieldError> {
    if let Ok(word) = field.text() {
        return match word {
            "robot" => Ok(PartyName::Robot),
            "everything" => Ok(PartyName::Everything),
            _ => {
                Err(field
                    .error(format!("is {word:?}, not \"robot\", \"everything\" or {{object, group or link: NAME}}")))
            }
        };
    }
    field.only(&["object", "group", "link"])?;
    let kinds: [(_, Named); 3] =
        [("object", PartyName::Object), ("group", PartyName::Group), ("link", PartyName::Link)];
    let named: Vec<_> = kinds.into_iter().filter_map(|(kind, of)| Some((field.optional(kind)?, of))).collect();
    match named.as_slice() {
        [(name, of)] => Ok(of(name.text()?.to_owned())),
        _ => Err(field.error("has to have one of: object, group, link")),
    }
}

fn effect(field: &Field) -> Result<Effect, FieldError> {
    let word = field.text()?;
    Effect::EACH.into_iter().find(|effect| effect.name() == word).ok_or_else(|| {
        let known = Effect::EACH.map(Effect::name).join(", ");
        field.error(format!("is {word:?}, which is none of: {known}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, json};

    fn read(effects: Value) -> Result<Vec<DeclaredPair>, String> {
        let document = json!({ "effects": effects });
        read_effects(Field::root(&document).optional("effects").as_ref()).map_err(|error| error.to_string())
    }

    #[test]
    fn parties_and_effects_are_read() {
        let declared = read(json!([
            {"between": ["robot", {"group": "shelves"}], "effects": ["distance", "motion"]},
            {"between": [{"object": "can"}, "everything"], "effects": []},
            {"between": [{"link": "hand"}, "robot"], "effects": ["patch"]},
        ]));
        let [one, two, three] = declared.unwrap().try_into().unwrap();
        assert_eq!(one.between, [PartyName::Robot, PartyName::Group("shelves".to_owned())]);
        assert_eq!(one.effects, Effects::of(Effect::Distance).and(Effects::of(Effect::Motion)));
        assert!(two.effects.is_empty() && two.between[1] == PartyName::Everything);
        let hand = Party::Link { robot: "r".to_owned(), link: "hand".to_owned() };
        assert_eq!(three.between.map(|party| party.in_scene("r")), [hand, Party::Robot("r".to_owned())]);
        assert_eq!(read(Value::Null), Ok(Vec::new()));
    }

    #[test]
    fn what_makes_no_sense_is_named() {
        let both = json!(["robot", "everything"]);
        for (effects, complaint) in [
            (
                json!([{"between": both, "effects": ["colour"]}]),
                "effects[0].effects[0]: is \"colour\", which is none of: verdict",
            ),
            (json!([{"between": both}]), "effects[0].effects: is missing"),
            (json!([{"between": ["robot"], "effects": []}]), "effects[0].between: has 1"),
            (json!([{"between": ["arm", "robot"], "effects": []}]), "effects[0].between[0]: is \"arm\", not \"robot\""),
            (json!([{"between": [{}, "robot"], "effects": []}]), "effects[0].between[0]: has to have one of"),
            (json!([{"between": both, "effects": [], "margin": 1}]), "effects[0]: has a member \"margin\""),
        ] {
            let told = read(effects).unwrap_err();
            assert!(told.starts_with(complaint), "{told}");
        }
    }
}
