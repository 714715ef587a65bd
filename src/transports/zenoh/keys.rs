//! What are things called in zenoh's space of keys? `docs/zenoh.md` has the same as a table.

use percent_encoding::{AsciiSet, NON_ALPHANUMERIC, percent_decode_str, utf8_percent_encode};
use zenoh::key_expr::{KeyExpr, OwnedKeyExpr};

/// Version of the keys.
const VERSION: &str = "v1";
/// What a name keeps in a key. zenoh gives `*`, `$`, `?`, `#`, `/` and a leading `@` meanings of their own.
const ESCAPED: &AsciiSet = &NON_ALPHANUMERIC.remove(b'-').remove(b'.').remove(b'_').remove(b'~');
/// Longest id that a caller gives itself, bytes.
const LONGEST_ID: usize = 128;

/// The keys of one daemon.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keys {
    root: String,
}

/// Why a text is no prefix.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("zenoh.prefix {prefix:?} is no key without wildcards")]
pub struct BadPrefix {
    /// As it was given.
    pub prefix: String,
}

/// What a put moves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Posed {
    /// Everything in its message.
    Many,
    /// What its key names.
    One(Of),
}

/// What a single pose is of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Of {
    /// A body, by its name.
    Body(String),
    /// A body, by its id.
    Id(u64),
    /// A robot's base, by the robot's name.
    Robot(String),
}

impl Keys {
    /// The keys under a prefix.
    ///
    /// # Errors
    /// It is no key, or one with wildcards.
    pub fn new(prefix: &str) -> Result<Self, BadPrefix> {
        let bad = || BadPrefix { prefix: prefix.to_owned() };
        let key = OwnedKeyExpr::new(prefix.to_owned()).map_err(|_| bad())?;
        if key.is_wild() || prefix.contains(['%', '@']) {
            Err(bad())
        } else {
            Ok(Self { root: format!("{prefix}/{VERSION}") })
        }
    }

    /// The prefix they begin with.
    #[must_use]
    pub fn prefix(&self) -> &str {
        self.root.strip_suffix(VERSION).and_then(|prefix| prefix.strip_suffix('/')).unwrap_or_default()
    }

    /// All calls.
    #[must_use]
    pub fn calls(&self) -> String {
        format!("{}/call/**", self.root)
    }

    /// Calls of an rpc, by `SERVICE/METHOD`.
    #[must_use]
    pub fn call(&self, rpc: &str) -> String {
        format!("{}/call/{rpc}", self.root)
    }

    /// `SERVICE/METHOD` of a key of calls.
    #[must_use]
    pub fn rpc_of<'k>(&self, key: &'k str) -> Option<&'k str> {
        key.strip_prefix(&*self.root)?.strip_prefix("/call/")
    }

    /// Poses of all scenes: many at a time, and one at a time.
    #[must_use]
    pub fn all_poses(&self) -> [String; 2] {
        [format!("{}/scene/*/poses", self.root), format!("{}/scene/*/pose/*/*", self.root)]
    }

    /// Where poses of a scene are put, many at a time.
    #[must_use]
    pub fn poses(&self, scene: &str) -> String {
        self.of_scene(scene, "poses")
    }

    /// Where one pose is put.
    #[must_use]
    pub fn pose(&self, scene: &str, of: &Of) -> String {
        let of = match of {
            Of::Body(name) => format!("pose/body/{}", chunk(name)),
            Of::Id(id) => format!("pose/id/{id}"),
            Of::Robot(name) => format!("pose/robot/{}", chunk(name)),
        };
        self.of_scene(scene, &of)
    }

    /// Whose pose is put under a key, and in which scene.
    #[must_use]
    pub fn posed(&self, key: &str) -> Option<(String, Posed)> {
        let (scene, rest) = key.strip_prefix(&*self.root)?.strip_prefix("/scene/")?.split_once('/')?;
        let posed = match *rest.split('/').collect::<Vec<_>>() {
            ["poses"] => Posed::Many,
            ["pose", "body", body] => Posed::One(Of::Body(name(body)?)),
            ["pose", "id", id] => Posed::One(Of::Id(id.parse().ok()?)),
            ["pose", "robot", robot] => Posed::One(Of::Robot(name(robot)?)),
            _ => return None,
        };
        Some((name(scene)?, posed))
    }

    /// What became of poses.
    #[must_use]
    pub fn poses_made(&self, scene: &str) -> String {
        self.of_scene(scene, "poses/made")
    }

    /// Puts of poses that could not be taken.
    #[must_use]
    pub fn poses_refused(&self, scene: &str) -> String {
        self.of_scene(scene, "poses/refused")
    }

    /// Steps of a scene.
    #[must_use]
    pub fn changes(&self, scene: &str) -> String {
        self.of_scene(scene, "changes")
    }

    /// Token of a scene.
    #[must_use]
    pub fn scene_alive(&self, scene: &str) -> String {
        self.of_scene(scene, "alive")
    }

    /// Token of the daemon.
    #[must_use]
    pub fn alive(&self) -> String {
        format!("{}/alive", self.root)
    }

    /// Token of a caller.
    #[must_use]
    pub fn client(&self, id: &str) -> String {
        format!("{}/client/{id}", self.root)
    }

    /// Tokens of all callers.
    #[must_use]
    pub fn all_clients(&self) -> String {
        self.client("**")
    }

    /// The caller whose token it is.
    #[must_use]
    pub fn client_of<'k>(&self, key: &'k str) -> Option<&'k str> {
        key.strip_prefix(&*self.root)?.strip_prefix("/client/")
    }

    fn of_scene(&self, scene: &str, what: &str) -> String {
        format!("{}/scene/{}/{what}", self.root, chunk(scene))
    }
}

/// Whether a caller may call itself so.
#[must_use]
pub fn is_client_id(id: &str) -> bool {
    id.len() <= LONGEST_ID && KeyExpr::new(id).is_ok_and(|key| !key.is_wild())
}

/// A name as a part of a key.
fn chunk(name: &str) -> String {
    utf8_percent_encode(name, ESCAPED).to_string()
}

/// The name that a part of a key stands for.
fn name(chunk: &str) -> Option<String> {
    percent_decode_str(chunk).decode_utf8().ok().map(Into::into)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn keys() -> Keys {
        Keys::new("site/clearance").unwrap()
    }

    #[test]
    fn keys_are_those_of_the_page() {
        let keys = keys();
        assert_eq!(keys.call("Queries/Collide"), "site/clearance/v1/call/Queries/Collide");
        assert_eq!(keys.poses("cell 1"), "site/clearance/v1/scene/cell%201/poses");
        assert_eq!(keys.pose("cell", &Of::Body("a*".into())), "site/clearance/v1/scene/cell/pose/body/a%2A");
        assert_eq!(keys.prefix(), "site/clearance");
        for bad in ["", "/", "a//b", "a/*", "a/**", "a$*", "a?b", "a/#", "a%20", "@a"] {
            assert_eq!(Keys::new(bad), Err(BadPrefix { prefix: bad.to_owned() }), "{bad}");
        }
    }

    #[test]
    fn what_is_not_a_key_of_ours_is_nobodys_pose() {
        let keys = keys();
        for other in [
            "other/v1/scene/a/poses",
            "site/clearance/v1/scene/a",
            "site/clearance/v1/scene/a/pose/body",
            "site/clearance/v1/scene/a/pose/id/x",
            "site/clearance/v1/scene/a/pose/leg/x",
            "site/clearance/v1/scene/%ff/poses",
        ] {
            assert_eq!(keys.posed(other), None, "{other}");
        }
    }

    #[test]
    fn ids_of_callers_have_no_wildcards() {
        assert!(is_client_id("0f3a") && is_client_id("planner/3"));
        assert!(!is_client_id("") && !is_client_id("a/*") && !is_client_id("a//b") && !is_client_id(&"x".repeat(129)));
    }

    proptest! {
        #[test]
        fn every_name_comes_back_from_its_key(scene in "\\PC{1,20}", body in "\\PC{1,20}", id: u64) {
            let keys = keys();
            for of in [Of::Body(body.clone()), Of::Id(id), Of::Robot(body)] {
                let key = keys.pose(&scene, &of);
                prop_assert!(KeyExpr::new(key.as_str()).is_ok_and(|key| !key.is_wild()), "{}", key);
                prop_assert_eq!(keys.posed(&key), Some((scene.clone(), Posed::One(of))));
            }
            prop_assert_eq!(keys.posed(&keys.poses(&scene)), Some((scene, Posed::Many)));
        }
    }
}
