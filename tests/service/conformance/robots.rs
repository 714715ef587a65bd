//! Robots in scenes and questions about their states.

use clearance::limits::Limits;
use clearance::transports::wire::v1;
use tonic::Code;

use super::through_every_door;
use crate::support::door::Door;
use crate::support::messages::*;

through_every_door!(
    states_are_checked_against_the_scene,
    the_same_description_is_the_same_model,
    meshes_come_from_what_was_uploaded,
    the_bulk_form_says_the_same,
    the_first_hit_stops_the_batch,
    wrong_numbers_of_joint_positions_are_refused,
    a_state_that_cannot_be_is_invalid_and_the_others_are_answered,
    descriptions_that_make_no_robot_are_refused,
    unknown_robots_are_named,
);

fn limits() -> Limits {
    Limits::default()
}

const LOWERED: [f64; 2] = [0.0, -0.5];
const TURNED: [f64; 2] = [1.5, 0.0];
const DRIVEN_IN: [f64; 2] = [0.0, -0.9];

/// A crane over a block that its hook reaches when it is lowered.
async fn crane(door: &impl Door) -> v1::RobotModel {
    let robot = door.load_robot(load(ROBOT)).await.unwrap();
    door.create_scene(SCENE).await.unwrap();
    let block = add("block", cuboid(0.2, 0.2, 0.2), at(1.0, 0.0, -1.0));
    door.apply(apply(vec![add_robot("arm", &robot.id), block])).await.unwrap();
    robot
}

async fn states_are_checked_against_the_scene(door: &impl Door) {
    let robot = crane(door).await;
    assert_eq!(robot.degrees_of_freedom, 2);
    assert_eq!(robot.joints.iter().map(|joint| joint.name.as_str()).collect::<Vec<_>>(), ["turn", "lower"]);
    assert_eq!(robot.joints[1].kind(), v1::JointKind::Prismatic);
    let mut question = states([LOWERED, DRIVEN_IN, TURNED].concat());
    question.context.as_mut().unwrap().wants = Some(v1::Wants { distance: true, ..v1::Wants::default() });
    let answer = door.check_states(question).await.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::Free, v1::Verdict::Collision, v1::Verdict::Free]);
    // The hook's ball ends 0.2 m above the block.
    let nearest = answer.items[0].nearest_scene.as_ref().unwrap();
    let bracket = nearest.bracket.unwrap();
    assert!(bracket.lower <= 0.2 + 1e-12 && 0.2 - 1e-12 <= bracket.upper, "{bracket:?}");
    let Some(v1::side::Kind::Link(side)) = nearest.a.as_ref().unwrap().kind else { panic!("{nearest:?}") };
    assert_eq!(robot.links[side.link as usize].name, "hook");
}

async fn the_same_description_is_the_same_model(door: &impl Door) {
    let first = door.load_robot(load(ROBOT)).await.unwrap();
    assert_eq!(door.load_robot(load(ROBOT)).await.unwrap(), first);
    let padded = door.load_robot(v1::LoadRobotRequest { padding: 0.01, ..load(ROBOT) }).await.unwrap();
    assert_ne!(padded.id, first.id);
}

async fn meshes_come_from_what_was_uploaded(door: &impl Door) {
    let refusal = door.load_robot(load_with_mesh(&announced(TETRAHEDRON).sha256)).await.unwrap_err();
    assert_eq!(refusal.code, Code::InvalidArgument);
    assert!(refusal.message.contains("corner.obj"), "{refusal:?}");
    let stored = door.put_asset(announced(TETRAHEDRON), TETRAHEDRON).await.unwrap();
    let robot = door.load_robot(load_with_mesh(&stored.sha256)).await.unwrap();
    assert_eq!((robot.degrees_of_freedom, robot.links[0].shapes), (0, 1));
}

async fn the_bulk_form_says_the_same(door: &impl Door) {
    crane(door).await;
    let positions = [LOWERED, DRIVEN_IN, TURNED].concat();
    let mut items = states(positions.clone());
    items.context.as_mut().unwrap().wants = Some(v1::Wants { distance: true, ..v1::Wants::default() });
    let mut bulk = items.clone();
    bulk.context.as_mut().unwrap().answer_form = v1::AnswerForm::Bulk.into();
    let bytes: Vec<u8> = positions.iter().copied().flat_map(f64::to_le_bytes).collect();
    bulk.positions = Some(v1::Doubles { form: Some(v1::doubles::Form::LittleEndian(bytes.into())) });
    let (items, bulk) = (door.check_states(items).await.unwrap(), door.check_states(bulk).await.unwrap());
    assert!(bulk.items.is_empty() && bulk.cost == items.cost);
    let arrays = bulk.bulk.unwrap();
    let numbers: Vec<u8> = items.items.iter().map(|item| u8::try_from(item.verdict).unwrap()).collect();
    assert_eq!(arrays.verdicts, numbers);
    let lower: Vec<u8> = items
        .items
        .iter()
        .flat_map(|item| item.nearest.as_ref().map_or(f64::NAN, |pair| pair.bracket.unwrap().lower).to_le_bytes())
        .collect();
    assert_eq!(arrays.nearest.unwrap().lower, lower);
}

async fn the_first_hit_stops_the_batch(door: &impl Door) {
    crane(door).await;
    let mut question = states([TURNED, DRIVEN_IN, TURNED, DRIVEN_IN].concat());
    question.mode = v1::Mode::StopAtFirst.into();
    let answer = door.check_states(question).await.unwrap();
    assert_eq!(answer.stopped_at, Some(1));
    assert_eq!(
        verdicts(&answer),
        [v1::Verdict::Free, v1::Verdict::Collision, v1::Verdict::NotRun, v1::Verdict::NotRun]
    );
}

async fn wrong_numbers_of_joint_positions_are_refused(door: &impl Door) {
    crane(door).await;
    let refusal = door.check_states(states(vec![0.0; 3])).await.unwrap_err();
    assert_eq!((refusal.code, refusal.field.as_str()), (Code::InvalidArgument, "positions"), "{refusal:?}");
    let form = v1::doubles::Form::LittleEndian(vec![0; 15].into());
    let ragged = v1::CheckStatesRequest { positions: Some(v1::Doubles { form: Some(form) }), ..states(Vec::new()) };
    let refusal = door.check_states(ragged).await.unwrap_err();
    assert_eq!(refusal.field, "positions.little_endian", "{refusal:?}");
    let missing = v1::CheckStatesRequest { positions: None, ..states(Vec::new()) };
    assert_eq!(door.check_states(missing).await.unwrap_err().field, "positions");
    assert!(door.check_states(states(Vec::new())).await.unwrap().items.is_empty());
}

async fn a_state_that_cannot_be_is_invalid_and_the_others_are_answered(door: &impl Door) {
    crane(door).await;
    let answer = door.check_states(states(vec![0.0, f64::NAN, 1.5, 0.0])).await.unwrap();
    assert_eq!(verdicts(&answer), [v1::Verdict::InvalidInput, v1::Verdict::Free]);
    assert!(answer.items[0].problem.contains("lower"), "{:?}", answer.items[0].problem);
}

async fn descriptions_that_make_no_robot_are_refused(door: &impl Door) {
    for (urdf, word) in [
        ("", "XML"),
        ("<robot name='r'/>", "links"),
        ("<robot name='r'><link name='a'/><link name='b'/></robot>", "root"),
        (
            "<robot name='r'><link name='a'><collision><geometry><mesh filename='m.obj'/></geometry></collision></link></robot>",
            "m.obj",
        ),
    ] {
        let refusal = door.load_robot(load(urdf)).await.unwrap_err();
        assert_eq!(refusal.code, Code::InvalidArgument, "{refusal:?}");
        assert!(refusal.message.contains(word), "{refusal:?}");
    }
    let binding = v1::MeshBinding { filename: "m.obj".to_owned(), sha256: "no hash".to_owned() };
    let refusal = door.load_robot(v1::LoadRobotRequest { meshes: vec![binding], ..load(ROBOT) }).await.unwrap_err();
    assert_eq!(refusal.field, "meshes[0].sha256");
    let refusal = door.load_robot(v1::LoadRobotRequest { padding: f64::NAN, ..load(ROBOT) }).await.unwrap_err();
    assert_eq!(refusal.field, "padding");
}

async fn unknown_robots_are_named(door: &impl Door) {
    crane(door).await;
    let question = v1::CheckStatesRequest { robot: "nobody".to_owned(), ..states(LOWERED.to_vec()) };
    let refusal = door.check_states(question).await.unwrap_err();
    assert_eq!(refusal.code, Code::NotFound);
    assert!(refusal.message.contains("nobody"), "{refusal:?}");
    let refusal = door.apply(apply(vec![add_robot("other", "no such model")])).await.unwrap_err();
    assert_eq!(refusal.code, Code::NotFound, "{refusal:?}");
}
