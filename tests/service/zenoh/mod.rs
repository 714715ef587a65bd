//! What only zenoh has: keys and parameters, puts of poses, scenes that are followed, tokens, routers, certificates.

mod access;
mod calls;
mod changes;
mod faults;
mod poses;

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use prost::Message;

use crate::support::door::Door;
use crate::support::messages::*;
use crate::support::zenoh_door::Zenoh;

/// A daemon with a scene of spheres, one metre from the next along x.
async fn with_balls(limits: Limits, count: u32) -> Zenoh {
    let door = Zenoh::start(limits).await;
    door.create_scene(SCENE).await.unwrap();
    if count > 0 {
        let ball = |i: u32| add(&format!("ball {i}"), sphere(0.1), at(f64::from(i), 0.0, 0.0));
        door.apply(apply((0..count).map(ball).collect())).await.unwrap();
    }
    door
}

/// Moves the first of the balls.
fn moved(x: f64) -> v1::ApplyRequest {
    apply(vec![move_to(named("ball 0"), at(x, 0.0, 0.0))])
}

/// Asks about ellipsoids in one place, whose depths take seconds.
async fn slow_question(door: &impl Door) -> Vec<u8> {
    let radii = Some(vec3(1.0, 0.8, 0.6));
    let body = |i: u32| {
        let core = v1::shape::Core::Ellipsoid(v1::Ellipsoid { radii });
        add(&format!("slow {i}"), shape(core), at(0.001 * f64::from(i), 0.0, 0.0))
    };
    door.apply(apply((0..600).map(body).collect())).await.unwrap();
    let wants = Some(v1::Wants { witness: true, depth: true, ..v1::Wants::default() });
    let context = Some(v1::Context { wants, ..context() });
    v1::CollideRequest { context, ..collide(vec![all_pairs(); 20]) }.encode_to_vec()
}

fn get_scene() -> v1::GetSceneRequest {
    v1::GetSceneRequest { scene: SCENE.to_owned(), ..v1::GetSceneRequest::default() }
}
