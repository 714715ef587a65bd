//! Compiles `proto/` to Rust and keeps its descriptor for the reflection service.
//!
//! protox is a protobuf compiler in Rust, so a machine needs no `protoc`.

use std::path::PathBuf;
use std::{env, error::Error, fs};

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=proto");
    println!("cargo::rerun-if-changed=build.rs");
    let has = |feature: &str| env::var_os(feature).is_some();
    let grpc = has("CARGO_FEATURE_GRPC");
    if !grpc && !has("CARGO_FEATURE_SHARED_MEMORY") && !has("CARGO_FEATURE_ZENOH") {
        return Ok(());
    }
    let mut files: Vec<PathBuf> =
        fs::read_dir("proto/clearance/v1")?.map(|file| Ok(file?.path())).collect::<Result<_, std::io::Error>>()?;
    files.sort();
    let descriptors = protox::compile(files, ["proto"])?;
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set")?);
    fs::write(out.join("clearance.descriptors"), prost::Message::encode_to_vec(&descriptors))?;
    let mut config = prost_build::Config::new();
    config.bytes(["."]);
    tonic_prost_build::configure()
        .build_client(grpc)
        .build_server(grpc)
        .compile_fds_with_config(descriptors, config)?;
    Ok(())
}
