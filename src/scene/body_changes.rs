//! How bodies come, go and change.

use std::sync::Arc;

use super::change::Fault;
use super::edit::{BodyRef, NewBody};
use super::party::PartyKey;
use super::{Body, BodyId, ChangeKinds, Reason, Snapshot};
use crate::geometry::{Aabb, Core, Pose, Shape, Vec3, Voxels};
use crate::limits::{LimitExceeded, Limits};

impl Snapshot {
    pub(super) fn add_body(&mut self, new: &NewBody, limits: &Limits) -> Result<BodyId, Fault> {
        let NewBody { name, shape, scale, padding, pose, groups, layers, mask } = new;
        self.check_new_name(name, limits)?;
        LimitExceeded::check("max_bodies", self.bodies.len() + 1, limits.max_bodies)
            .map_err(|limit| Reason::Limit(limit).of("name"))?;
        let shape = inflated(shape, *scale, *padding)?;
        let (groups, group_keys) = self.join_groups(groups, limits)?;
        let id = self.next_body;
        self.next_body = BodyId(id.0 + 1);
        let name: Arc<str> = name.as_str().into();
        self.names.insert_mut(Arc::clone(&name), id);
        let placement = pose.placement();
        let body = Body {
            id,
            name,
            bounds: shape.placed_bounds(&placement),
            shape,
            scale: *scale,
            padding: *padding,
            pose: *pose,
            placement,
            groups,
            layers: *layers,
            mask: *mask,
            enabled: true,
            group_keys,
            proxy: None,
        };
        self.put(body);
        self.changes.body(id, ChangeKinds::ADDED);
        Ok(id)
    }

    pub(super) fn remove_body(&mut self, body: &BodyRef) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        self.unlist(&body);
        self.bodies.remove(body.id.0);
        self.names.remove_mut(&body.name);
        self.forget_entries_of(PartyKey::body(body.id));
        self.leave_groups(&body);
        self.changes.body(body.id, ChangeKinds::REMOVED);
        Ok(())
    }

    pub(super) fn move_body(&mut self, body: &BodyRef, pose: &Pose) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        if same_bits(&body.pose, pose) {
            return Ok(());
        }
        self.changes.body(body.id, ChangeKinds::MOVED);
        let placement = pose.placement();
        let bounds = body.shape.placed_bounds(&placement);
        self.put(Body { pose: *pose, placement, bounds, ..Body::clone(&body) });
        Ok(())
    }

    pub(super) fn replace_shape(
        &mut self,
        body: &BodyRef,
        shape: &Arc<Shape>,
        scale: f64,
        padding: f64,
    ) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        let shape = inflated(shape, scale, padding)?;
        self.changes.body(body.id, ChangeKinds::RESHAPED);
        let bounds = shape.placed_bounds(&body.placement);
        self.put(Body { shape, scale, padding, bounds, ..Body::clone(&body) });
        Ok(())
    }

    pub(super) fn insert_points(&mut self, body: &BodyRef, points: &[Vec3], limits: &Limits) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        let map = voxels_of(&body)?.with_points(points).map_err(|invalid| Reason::Shape(invalid).of("points"))?;
        LimitExceeded::check("max_voxel_cells", map.len(), limits.max_voxel_cells)
            .map_err(|limit| Reason::Limit(limit).of("points"))?;
        self.put_voxels(&body, map)
    }

    pub(super) fn clear_box(&mut self, body: &BodyRef, bounds: &Aabb) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        let map = voxels_of(&body)?.without_box(bounds).map_err(|invalid| Reason::Shape(invalid).of("box"))?;
        self.put_voxels(&body, map)
    }

    /// Another map in the place of a body's. Scale and padding are in the shape already.
    fn put_voxels(&mut self, body: &Body, map: Voxels) -> Result<(), Fault> {
        let kind = body.shape.kind();
        let shape = body.shape.with_voxels(map).ok_or_else(|| Reason::NotVoxels { kind }.of("body"))?;
        self.changes.body(body.id, ChangeKinds::RESHAPED);
        let bounds = shape.placed_bounds(&body.placement);
        self.put(Body { shape: Arc::new(shape), bounds, ..Body::clone(body) });
        Ok(())
    }

    pub(super) fn set_groups(&mut self, body: &BodyRef, groups: &[String], limits: &Limits) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        let (groups, group_keys) = self.join_groups(groups, limits)?;
        if group_keys != body.group_keys {
            self.changes.body(body.id, ChangeKinds::GROUPS);
        }
        self.leave_groups(&body);
        self.put(Body { groups, group_keys, ..Body::clone(&body) });
        Ok(())
    }

    pub(super) fn set_layers(&mut self, body: &BodyRef, layers: u32, mask: u32) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        if (layers, mask) != (body.layers, body.mask) {
            self.changes.body(body.id, ChangeKinds::LAYERS);
        }
        self.put(Body { layers, mask, ..Body::clone(&body) });
        Ok(())
    }

    pub(super) fn set_enabled(&mut self, body: &BodyRef, enabled: bool) -> Result<(), Fault> {
        let body = self.find(body, "body")?;
        if enabled != body.enabled {
            self.changes.body(body.id, ChangeKinds::ENABLED);
        }
        self.put(Body { enabled, ..Body::clone(&body) });
        Ok(())
    }

    /// The body that a reference means.
    pub(super) fn find(&self, body: &BodyRef, field: &'static str) -> Result<Arc<Body>, Fault> {
        let found = match body {
            BodyRef::Id(id) => self.body(*id),
            BodyRef::Name(name) => self.body_named(name),
        };
        found.cloned().ok_or_else(|| {
            let reason = match body {
                BodyRef::Id(id) if (BodyId(1)..self.next_body).contains(id) => Reason::BodyRemoved { id: *id },
                BodyRef::Id(id) => Reason::UnknownId { id: *id },
                BodyRef::Name(name) => Reason::UnknownBody { name: name.clone() },
            };
            reason.of(field)
        })
    }

    pub(super) fn check_new_name(&self, name: &str, limits: &Limits) -> Result<(), Fault> {
        if name.is_empty() {
            return Err(Reason::NameEmpty.of("name"));
        }
        LimitExceeded::check("max_name_bytes", name.len(), limits.max_name_bytes)
            .map_err(|limit| Reason::Limit(limit).of("name"))?;
        if self.names.contains_key(name) || self.robot(name).is_some() {
            return Err(Reason::NameTaken { name: name.to_owned() }.of("name"));
        }
        Ok(())
    }

    /// Puts a body in the place of the one with its id, and lists it where queries find it.
    fn put(&mut self, mut body: Body) {
        match (body.proxy, body.bounds.filter(|_| body.enabled)) {
            (Some(proxy), Some(bounds)) => drop(self.broad_phase.move_to(proxy, bounds)),
            (None, Some(bounds)) => {
                self.unlist(&body);
                body.proxy = Some(self.broad_phase.insert(bounds, body.id.0));
            }
            (_, None) => {
                self.unlist(&body);
                body.proxy = None;
            }
        }
        if body.is_unbounded() {
            let unbounded = Arc::make_mut(&mut self.unbounded);
            if let Err(place) = unbounded.binary_search(&body.id) {
                unbounded.insert(place, body.id);
            }
        }
        self.store(body);
    }

    /// Takes a body out of the broad phase and the list of those without bounds.
    fn unlist(&mut self, body: &Body) {
        if let Some(proxy) = body.proxy {
            self.broad_phase.remove(proxy);
        }
        if let Ok(place) = self.unbounded.binary_search(&body.id) {
            Arc::make_mut(&mut self.unbounded).remove(place);
        }
    }

    /// Counts a body into groups: their names in order, and their keys.
    fn join_groups(&mut self, names: &[String], limits: &Limits) -> Result<GroupLists, Fault> {
        let mut names: Vec<&str> = names.iter().map(String::as_str).collect();
        names.sort_unstable();
        names.dedup();
        LimitExceeded::check("max_groups", names.len(), limits.max_groups)
            .map_err(|limit| Reason::Limit(limit).of("groups"))?;
        for name in &names {
            check_group_name(name, "groups", limits)?;
        }
        let groups: Vec<(PartyKey, Arc<str>)> = names.into_iter().map(|name| self.groups.named(name)).collect();
        let mut keys: Vec<PartyKey> = groups.iter().map(|(key, _)| *key).collect();
        keys.sort_unstable();
        keys.iter().for_each(|key| self.groups.add_use(*key));
        Ok((groups.into_iter().map(|(_, name)| name).collect(), keys.into()))
    }

    fn leave_groups(&mut self, body: &Body) {
        body.group_keys.iter().for_each(|key| self.groups.drop_use(*key));
    }
}

fn voxels_of(body: &Body) -> Result<&Voxels, Fault> {
    if let Core::Voxels(map) = body.shape.core() {
        Ok(map)
    } else {
        Err(Reason::NotVoxels { kind: body.shape.kind() }.of("body"))
    }
}

/// Names of groups, sorted, and their keys, sorted.
type GroupLists = (Arc<[Arc<str>]>, Arc<[PartyKey]>);

pub(super) fn check_group_name(name: &str, field: &'static str, limits: &Limits) -> Result<(), Fault> {
    if name.is_empty() {
        return Err(Reason::NameEmpty.of(field));
    }
    LimitExceeded::check("max_name_bytes", name.len(), limits.max_name_bytes)
        .map_err(|limit| Reason::Limit(limit).of(field))
}

/// The shape scaled, then padded.
fn inflated(shape: &Arc<Shape>, scale: f64, padding: f64) -> Result<Arc<Shape>, Fault> {
    if !scale.is_finite() {
        return Err(Reason::NotFinite.of("scale"));
    }
    if scale <= 0.0 {
        return Err(Reason::NotPositive { value: scale }.of("scale"));
    }
    check_distance(padding, "padding")?;
    let mut shape = Arc::clone(shape);
    if scale != 1.0 {
        shape = Arc::new(shape.scaled(scale).map_err(|invalid| Reason::Shape(invalid).of("scale"))?);
    }
    if padding != 0.0 {
        shape = Arc::new(shape.swept(padding).map_err(|invalid| Reason::Shape(invalid).of("padding"))?);
    }
    Ok(shape)
}

/// Whether no question could tell the poses apart: zeros of different signs may show in an answer.
pub(super) fn same_bits(one: &Pose, two: &Pose) -> bool {
    let bits = |pose: &Pose| {
        let (t, q) = (pose.translation(), pose.rotation());
        [t.x, t.y, t.z, q.w, q.x, q.y, q.z].map(f64::to_bits)
    };
    bits(one) == bits(two)
}

/// Checks a length that a caller gave, metres.
pub(super) fn check_distance(value: f64, field: &'static str) -> Result<(), Fault> {
    if !value.is_finite() {
        return Err(Reason::NotFinite.of(field));
    }
    if value < 0.0 { Err(Reason::Negative { value }.of(field)) } else { Ok(()) }
}
