//! Every way a scene, a mesh or a list of balls can be wrong: what the user is told, and that no output is left behind.

use crate::common::{Folder, shown};

/// A scene with nothing wrong in it; each test breaks one thing.
const SCENE: &str = r#"version = 1
duration = 3.0
gravity = [0.0, 0.0, -9.81]

[air]
wind = [2.0, 0.0, 0.0]
drag = { linear = 0.05 }

[materials.clay]
restitution = 0.75
friction = { coulomb = 0.6 }

[[surfaces]]
name = "floor"
material = "clay"
shape = { plane = { point = [0, 0, 0], normal = [0, 0, 1] } }

[[surfaces]]
name = "ramp"
material = "clay"
shape = { polygon = [[0, 0, 0], [2, 0, 0], [2, 1, 0.5], [0, 1, 0.5]] }

[[balls]]
position = [0.0, 0.0, 1.0]
velocity = [1.0, 0.0, 0.0]
radius = 0.033
mass = 0.058
"#;

/// The scene with `from` replaced, which must be in it.
fn broken(from: &str, to: &str) -> String {
    assert!(SCENE.contains(from), "{from:?} is not in the scene");
    SCENE.replacen(from, to, 1)
}

/// Runs the files with all outputs wanted: they must fail with `code` and leave nothing behind. What the user sees is a snapshot.
#[track_caller]
fn refused(name: &str, files: &[(&str, &[u8])], args: &[&str], code: i32) {
    let folder = Folder::with(files);
    let before = folder.names();
    let output = folder.run(args);
    assert_eq!(output.status.code(), Some(code), "{}", shown(&output));
    assert!(output.stdout.is_empty(), "{}", shown(&output));
    assert_eq!(folder.names(), before, "files are left behind");
    insta::assert_snapshot!(name, shown(&output));
}

const RUN: [&str; 8] =
    ["run", "scene.toml", "--events", "events.csv", "--frames", "frames.jsonl", "--summary", "summary.json"];

#[track_caller]
fn refused_scene(name: &str, scene: &str) {
    refused(name, &[("scene.toml", scene.as_bytes())], &RUN, 3);
}

#[track_caller]
fn refused_json(name: &str, scene: &str) {
    let args = ["run", "scene.json", "--events", "events.csv"];
    refused(name, &[("scene.json", scene.as_bytes())], &args, 3);
}

/// The scene with its ramp a mesh from this file.
#[track_caller]
fn refused_mesh(name: &str, file: &str, content: &[u8]) {
    let polygon = "polygon = [[0, 0, 0], [2, 0, 0], [2, 1, 0.5], [0, 1, 0.5]]";
    let scene = broken(polygon, &format!("mesh = {{ file = \"{file}\" }}"));
    refused(name, &[("scene.toml", scene.as_bytes()), (file, content)], &RUN, 3);
}

#[track_caller]
fn refused_balls(name: &str, list: &str) {
    let files = [("scene.toml", SCENE.as_bytes()), ("balls.csv", list.as_bytes())];
    refused(name, &files, &["run", "scene.toml", "--balls", "balls.csv", "--events", "events.csv"], 3);
}

/// One test for each row: its name, the part of the scene to replace, and what to replace it with.
macro_rules! scenes {
    ($($name:ident: $from:expr => $to:expr;)*) => {$(
        #[test]
        fn $name() {
            refused_scene(stringify!($name), &broken($from, $to));
        }
    )*};
}

scenes! {
    unknown_key: "duration" => "duraton";
    unknown_key_in_a_ball: "radius" => "raduis";
    unknown_key_like_nothing: "gravity" => "quux";
    wrong_type: "duration = 3.0" => "duration = \"3.0\"";
    wrong_type_table: "[air]" => "air = 3\n[other]";
    syntax_error: "duration = 3.0" => "duration = = 3.0";
    key_twice: "duration = 3.0" => "duration = 3.0\nduration = 4.0";
    not_a_number: "[0.0, 0.0, -9.81]" => "[0.0, 0.0, nan]";
    infinite: "radius = 0.033" => "radius = inf";
    two_coordinates: "position = [0.0, 0.0, 1.0]" => "position = [0.0, 1.0]";
    four_coordinates: "position = [0.0, 0.0, 1.0]" => "position = [0.0, 0.0, 1.0, 2.0]";
    missing_duration: "duration = 3.0" => "";
    missing_version: "version = 1" => "";
    unknown_version: "version = 1" => "version = 2";
    zero_duration: "duration = 3.0" => "duration = 0";
    negative_duration: "duration = 3.0" => "duration = -1.0";
    restitution_1_2: "restitution = 0.75" => "restitution = 1.2";
    missing_restitution: "restitution = 0.75" => "";
    negative_friction: "coulomb = 0.6" => "coulomb = -0.6";
    linear_friction_above_1: "coulomb = 0.6" => "linear = 1.5";
    two_laws_of_friction: "coulomb = 0.6" => "coulomb = 0.6, linear = 0.1";
    unknown_law_of_friction: "coulomb" => "colomb";
    negative_radius: "radius = 0.033" => "radius = -0.033";
    no_room: "[[balls]]" => "[[surfaces]]\nname = \"shelf\"\nmaterial = \"clay\"\nshape = { plane = { point = [0, 0, 0.98], normal = [0, 0, 1] } }\n\
        [[surfaces]]\nname = \"lid\"\nmaterial = \"clay\"\nshape = { plane = { point = [0, 0, 1.03], normal = [0, 0, 1] } }\n[[balls]]";
    no_materials: "[materials.clay]\nrestitution = 0.75\nfriction = { coulomb = 0.6 }" => "";
    zero_mass: "mass = 0.058" => "mass = 0";
    drag_without_mass: "mass = 0.058" => "";
    wind_without_drag: "drag = { linear = 0.05 }" => "";
    drag_without_density: "linear = 0.05" => "coefficient = 0.47";
    negative_density: "linear = 0.05" => "coefficient = 0.47, density = -1.2";
    two_laws_of_drag: "linear = 0.05" => "linear = 0.05, coefficient = 0.47, density = 1.2";
    no_law_of_drag: "{ linear = 0.05 }" => "{}";
    sphere_without_viscosity: "{ linear = 0.05 }" => "\"sphere\"\ndensity = 1.2";
    sphere_without_density: "{ linear = 0.05 }" => "\"sphere\"\nviscosity = 1.8e-5";
    unknown_drag: "{ linear = 0.05 }" => "\"spheer\"";
    drag_of_the_wrong_type: "{ linear = 0.05 }" => "0.05";
    magnus_without_density: "[air]" => "[air]\nmagnus = { coefficient = 1.0 }";
    negative_magnus: "[air]" => "[air]\ndensity = 1.2\nmagnus = { coefficient = -1.0 }";
    buoyancy_without_density: "[air]" => "[air]\nbuoyancy = true";
    negative_air: "[air]" => "[air]\ndensity = -1.2";
    spin_decay_of_no_time: "[air]" => "[air]\nspin_decay = 0";
    restitution_that_falls_above_nothing: "restitution = 0.75" => "restitution = { coefficient = 0.75, falls_above = 0 }";
    restitution_with_a_misspelt_key: "restitution = 0.75" => "restitution = { coefficient = 0.75, fals_above = 1 }";
    unknown_ball: "radius = 0.033" => "ball = \"tenis\"";
    drag_of_a_ball_that_has_none: "{ linear = 0.05 }" => "\"ball\"\ndensity = 1.2";
    restitution_of_a_ball_that_has_none: "restitution = 0.75" => "restitution = \"ball\"";
    restitution_of_what: "restitution = 0.75" => "restitution = \"bell\"";
    negative_drag_of_a_ball: "mass = 0.058" => "mass = 0.058\ndrag = -0.5";
    negative_grip: "coulomb = 0.6" => "grip = { mu = -0.6 }";
    tangential_above_1: "coulomb = 0.6" => "grip = { mu = 0.6, tangential = 1.5 }";
    negative_rolling: "coulomb = 0.6" => "grip = { mu = 0.6, rolling = -0.1 }";
    unknown_effects: "[air]" => "effects = \"all\"\n[air]";
    effects_to_nothing: "[air]" => "effects = { auto = 0 }\n[air]";
    inertia_above_1: "mass = 0.058" => "mass = 0.058\ninertia = 1.2";
    unknown_material: "material = \"clay\"" => "material = \"caly\"";
    surface_without_material: "material = \"clay\"" => "";
    surface_without_shape: "shape = { plane = { point = [0, 0, 0], normal = [0, 0, 1] } }" => "";
    name_twice: "name = \"ramp\"" => "name = \"floor\"";
    unknown_shape: "plane" => "plain";
    zero_normal: "normal = [0, 0, 1]" => "normal = [0, 0, 0]";
    zero_coefficients: "point = [0, 0, 0], normal = [0, 0, 1]" => "coefficients = [0, 0, 0, 1]";
    plane_without_normal: "point = [0, 0, 0], normal = [0, 0, 1]" => "point = [0, 0, 0]";
    collinear_polygon: "[[0, 0, 0], [2, 0, 0], [2, 1, 0.5], [0, 1, 0.5]]" => "[[0, 0, 0], [1, 0, 0], [2, 0, 0]]";
    bow_tie: "[2, 1, 0.5], [0, 1, 0.5]" => "[0, 1, 0.5], [2, 1, 0.5]";
    self_crossing_polygon: "[[0, 0, 0], [2, 0, 0], [2, 1, 0.5], [0, 1, 0.5]]"
        => "[[0, 3, 0], [2, -3, 0], [-3, 1, 0], [3, 1, 0], [-2, -3, 0]]";
    polygon_of_two: "[2, 0, 0], [2, 1, 0.5], [0, 1, 0.5]" => "[2, 0, 0]";
    polygon_out_of_plane: "[0, 1, 0.5]" => "[0, 1, 0.7]";
    polygon_vertex_twice: "[2, 0, 0]," => "[2, 0, 0], [2, 0, 0],";
    grid_of_none: "radius = 0.033" => "grid = { count = [2, 0, 1], step = [1, 1, 1] }";
    grid_too_large: "radius = 0.033" => "grid = { count = [100000, 100000, 1], step = [1, 1, 1] }";
    grid_of_half_balls: "radius = 0.033" => "grid = { count = [2, 0.5, 1], step = [1, 1, 1] }";
    exact_with_drag: "[air]" => "method = { integrator = \"exact\" }\n[air]";
    step_missing: "[air]" => "method = { integrator = \"rk4\" }\n[air]";
    step_with_exact: "[air]" => "method = { integrator = \"exact\", step = 0.1 }\n[air]";
    zero_step: "[air]" => "method = { integrator = \"euler\", step = 0 }\n[air]";
    tolerance_with_euler: "[air]" => "method = { integrator = \"euler\", step = 0.1, tolerance = 1e-9 }\n[air]";
    unknown_integrator: "[air]" => "method = { integrator = \"rk5\", step = 0.1 }\n[air]";
    rest_by_two_rules: "[air]" => "rest = { length = 1e-6, speed = 1e-3 }\n[air]";
    rest_length_zero: "[air]" => "rest = { length = 0 }\n[air]";
    rest_force_negative: "[air]" => "rest = { speed = 0.1, distance = 0.1, force = -1 }\n[air]";
}

#[test]
fn several_at_once_are_all_told_in_the_order_of_the_file() {
    let scene = broken("restitution = 0.75", "restitution = 7.5")
        .replace("0.033", "-1")
        .replace("duration = 3.0", "duration = 0");
    refused_scene("several_at_once", &scene);
    let scene = broken("restitution", "restituton").replace("radius", "raduis");
    refused_scene("several_keys_at_once", &scene);
}

#[test]
fn quadratic_drag_without_mass() {
    let scene = broken("linear = 0.05", "coefficient = 0.47, density = 1.2").replace("mass = 0.058", "");
    refused_scene("quadratic_drag_without_mass", &scene);
}

#[test]
fn no_balls() {
    let end = SCENE.find("[[balls]]").expect("the scene has balls");
    refused_scene("no_balls", &SCENE[..end]);
}

#[test]
fn empty_scene() {
    refused_scene("empty_scene", "");
}

#[test]
fn scene_that_is_not_text() {
    refused("scene_that_is_not_text", &[("scene.toml", b"version = 1\nduration = \xff\xfe")], &RUN, 3);
}

#[test]
fn missing_scene() {
    refused("missing_scene", &[], &RUN, 1);
}

#[test]
fn scene_of_unknown_kind() {
    refused("scene_of_unknown_kind", &[("scene.txt", SCENE.as_bytes())], &["run", "scene.txt"], 2);
}

const JSON: &str = r#"{
  "version": 1,
  "duration": 3,
  "materials": { "clay": { "restitution": 0.75 } },
  "surfaces": [
    { "name": "floor", "material": "clay", "shape": { "plane": { "coefficients": [0, 0, 1, 0] } } }
  ],
  "balls": [{ "position": [0, 0, 1] }]
}
"#;

#[test]
fn json_scenes_are_told_their_places_too() {
    refused_json("json_unknown_key", &JSON.replace("restitution", "restituton"));
    refused_json("json_wrong_type", &JSON.replace("[0, 0, 1] }", "[0, true, 1] }"));
    refused_json("json_null", &JSON.replace("\"duration\": 3", "\"duration\": null"));
    refused_json("json_trailing_comma", &JSON.replace("[0, 0, 1] }]", "[0, 0, 1] }],"));
    refused_json("json_key_twice", &JSON.replace("\"duration\": 3", "\"duration\": 3, \"duration\": 4"));
    refused_json("json_overflow", &JSON.replace("\"duration\": 3", "\"duration\": 1e999"));
    refused_json("json_restitution", &JSON.replace("0.75", "1.2"));
    refused_json("json_empty", "");
}

#[test]
fn meshes_in_obj() {
    refused_mesh("obj_index_out_of_range", "hill.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n");
    refused_mesh("obj_index_zero", "hill.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n");
    refused_mesh("obj_index_before_the_first", "hill.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n");
    refused_mesh("obj_index_huge", "hill.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999\n");
    refused_mesh("obj_nan", "hill.obj", b"v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n");
    refused_mesh("obj_word_for_a_number", "hill.obj", b"v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n");
    refused_mesh("obj_two_coordinates", "hill.obj", b"v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n");
    refused_mesh("obj_face_of_two", "hill.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n");
    refused_mesh("obj_bow_tie_face", "hill.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3 4\n");
    refused_mesh("obj_empty", "hill.obj", b"");
    refused_mesh("obj_without_faces", "hill.obj", b"v 0 0 0\nv 1 0 0\n");
    refused_mesh("obj_that_is_none", "hill.obj", b"%PDF-1.4\n1 0 obj\n");
    refused_mesh("mesh_of_unknown_kind", "hill.gltf", b"{}");
}

#[test]
fn missing_mesh() {
    let scene = broken("plane = { point = [0, 0, 0], normal = [0, 0, 1] }", "mesh = { file = \"nowhere.obj\" }");
    refused_scene("missing_mesh", &scene);
    let scene =
        broken("plane = { point = [0, 0, 0], normal = [0, 0, 1] }", "mesh = { file = \"hill.obj\", scale = 0 }");
    refused_scene("mesh_scale_zero", &scene);
    let scene =
        broken("plane = { point = [0, 0, 0], normal = [0, 0, 1] }", "mesh = { file = \"hill.obj\", up = \"w\" }");
    refused_scene("mesh_up_w", &scene);
}

/// A binary STL of these facets, its header and count as given.
fn stl(header: &[u8], count: u32, facets: &[[f32; 9]]) -> Vec<u8> {
    let mut bytes = vec![b' '; 80];
    bytes[..header.len()].copy_from_slice(header);
    bytes.extend(count.to_le_bytes());
    for facet in facets {
        bytes.extend([0; 12]);
        facet.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn meshes_in_stl() {
    let facet = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    refused_mesh("stl_cut_off", "hill.stl", &stl(b"", 2, &[facet]));
    refused_mesh("stl_nan", "hill.stl", &stl(b"", 2, &[facet, [f32::NAN; 9]]));
    refused_mesh("stl_empty", "hill.stl", b"");
    refused_mesh("stl_of_no_facets", "hill.stl", &stl(b"", 0, &[]));
    refused_mesh("stl_that_is_none", "hill.stl", b"just some words");
    let ascii = "solid hill\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
    refused_mesh("stl_ascii_cut_off", "hill.stl", &ascii.as_bytes()[..70]);
    refused_mesh("stl_ascii_word_for_a_number", "hill.stl", ascii.replace("1 0 0", "1 o 0").as_bytes());
    refused_mesh("stl_ascii_two_vertices", "hill.stl", ascii.replace("vertex 1 0 0\n", "").as_bytes());
}

#[test]
fn meshes_in_ply() {
    let ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n\
        element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    refused_mesh("ply_index_out_of_range", "hill.ply", ply.replace("3 0 1 2", "3 0 1 3").as_bytes());
    refused_mesh("ply_index_negative", "hill.ply", ply.replace("3 0 1 2", "3 0 1 -1").as_bytes());
    refused_mesh("ply_cut_off", "hill.ply", &ply.as_bytes()[..ply.len() - 14]);
    refused_mesh("ply_nan", "hill.ply", ply.replace("0 1 0", "0 nan 0").as_bytes());
    refused_mesh("ply_word_for_a_number", "hill.ply", ply.replace("0 1 0", "0 x 0").as_bytes());
    refused_mesh("ply_without_z", "hill.ply", ply.replace("property double z\n", "").as_bytes());
    refused_mesh("ply_of_no_faces", "hill.ply", ply.replace("element face 1", "element face 0").as_bytes());
    refused_mesh(
        "ply_of_endless_faces",
        "hill.ply",
        ply.replace("element face 1", "element face 999999999999").as_bytes(),
    );
    refused_mesh("ply_face_of_two", "hill.ply", ply.replace("3 0 1 2", "2 0 1").as_bytes());
    refused_mesh("ply_empty", "hill.ply", b"");
    refused_mesh("ply_that_is_none", "hill.ply", b"just some words\n");
}

#[test]
fn lists_of_balls() {
    refused_balls("balls_word_for_a_number", "x,y,z\n0,0,1\n0,zero,1\n");
    refused_balls("balls_nan", "x,y,z\n0,0,NaN\n");
    refused_balls("balls_too_few_values", "x,y,z,radius\n0,0,1\n");
    refused_balls("balls_unknown_column", "x,y,z,raduis\n0,0,1,0.1\n");
    refused_balls("balls_column_twice", "x,y,z,x\n0,0,1,0.1\n");
    refused_balls("balls_without_z", "x,y\n0,0\n");
    refused_balls("balls_negative_radius", "x,y,z,mass,radius\n0,0,1,1,0.1\n0,0,1,1,-0.1\n");
    refused_balls("balls_without_mass", "x,y,z\n0,0,1\n");
    refused_balls("balls_none", "x,y,z\n");
    refused_balls("balls_empty_file", "");
    let files = [("scene.toml", SCENE.as_bytes())];
    refused("balls_missing_file", &files, &["run", "scene.toml", "--balls", "balls.csv"], 1);
}
