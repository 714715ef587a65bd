//! Which groups are there? Names and keys, for as long as a body is in a group or an entry speaks of it.

use std::sync::Arc;

use rpds::HashTrieMapSync;

use super::id_map::IdMap;
use super::party::PartyKey;

/// The groups in use. A clone shares everything until one side changes.
#[derive(Clone, Debug)]
pub(super) struct Groups {
    // Never iterated: its order is not the same twice.
    keys: HashTrieMapSync<Arc<str>, PartyKey>,
    groups: IdMap<Group>,
    /// Numbers are never used again.
    next_number: u64,
}

#[derive(Clone, Debug)]
struct Group {
    name: Arc<str>,
    /// Bodies in it and entries that name it.
    uses: usize,
}

impl Groups {
    pub(super) fn new() -> Self {
        Self { keys: HashTrieMapSync::new_sync(), groups: IdMap::new(), next_number: 0 }
    }

    /// Bytes of all nodes, those that other versions hold too included.
    pub(super) fn memory(&self) -> usize {
        self.groups.memory()
    }

    /// Bytes of the nodes that no other version holds.
    pub(super) fn own_memory(&self) -> usize {
        self.groups.own_memory()
    }

    pub(super) fn len(&self) -> usize {
        self.groups.len()
    }

    pub(super) fn key(&self, name: &str) -> Option<PartyKey> {
        self.keys.get(name).copied()
    }

    /// What a group in use is called.
    pub(super) fn name(&self, key: PartyKey) -> Option<&Arc<str>> {
        key.is_group().then(|| self.groups.get(key.number()))?.map(|group| &group.name)
    }

    pub(super) fn uses(&self, key: PartyKey) -> usize {
        self.groups.get(key.number()).map_or(0, |group| group.uses)
    }

    /// The key of a group and the one allocation of its name. A name not in use gets a new key, and begins to count
    /// with its first use.
    pub(super) fn named(&mut self, name: &str) -> (PartyKey, Arc<str>) {
        if let Some(key) = self.key(name)
            && let Some(group) = self.groups.get(key.number())
        {
            return (key, Arc::clone(&group.name));
        }
        let key = PartyKey::group(self.next_number);
        self.next_number += 1;
        let name: Arc<str> = name.into();
        self.keys.insert_mut(Arc::clone(&name), key);
        self.groups.insert(key.number(), Group { name: Arc::clone(&name), uses: 0 });
        (key, name)
    }

    pub(super) fn add_use(&mut self, key: PartyKey) {
        if let Some(group) = self.groups.get_mut(key.number()) {
            group.uses += 1;
        }
    }

    /// Counts one use less; a group that nobody uses is forgotten.
    pub(super) fn drop_use(&mut self, key: PartyKey) {
        let Some(group) = self.groups.get_mut(key.number()) else { return };
        group.uses -= 1;
        if group.uses == 0
            && let Some(group) = self.groups.remove(key.number())
        {
            self.keys.remove_mut(&group.name);
        }
    }
}
