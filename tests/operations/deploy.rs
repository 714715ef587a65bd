//! Do the files of `deploy/` fit the program? Each is read, what it says of the program is tried on the program, and every metric
//! that it names is one that the program tells.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use serde_json::Value;

use crate::metrics::well_used;
use crate::repository;
use crate::scrape::Scrape;

fn read(path: &str) -> String {
    fs::read_to_string(repository(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Every document of a YAML file.
fn yaml(path: &str) -> Vec<Value> {
    serde_saphyr::from_multiple(&read(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn one(path: &str) -> Value {
    let documents = yaml(path);
    assert_eq!(documents.len(), 1, "{path}");
    documents.into_iter().next().unwrap()
}

/// Every file below a folder.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

fn strings(list: &Value) -> Vec<String> {
    list.as_array().unwrap().iter().map(|item| item.as_str().unwrap().to_owned()).collect()
}

/// What `clearance serve --check` says of these arguments, with the configuration file of the manifest in the place of the one that
/// is there at run time.
fn check(arguments: &[String], config: &str) {
    let config = repository(config);
    let mut arguments = arguments.to_vec();
    for i in 0..arguments.len() {
        if arguments[i].starts_with("--config=") {
            arguments[i] = format!("--config={}", config.display());
        } else if i > 0 && arguments[i - 1] == "--config" {
            arguments[i] = config.display().to_string();
        }
    }
    let output = Command::new(env!("CARGO_BIN_EXE_clearance")).args(&arguments).arg("--check").output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// What the program says of `serve`'s flags.
fn help() -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_clearance")).args(["serve", "--help"]).output().unwrap();
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn every_file_can_be_read() {
    let (mut yamls, mut jsons, mut tomls) = (0, 0, 0);
    for path in files(&repository("deploy")) {
        let shown = path.strip_prefix(repository("")).unwrap().to_str().unwrap().to_owned();
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("yaml" | "yml") => yamls += usize::from(!yaml(&shown).is_empty()),
            Some("json") => jsons += usize::from(serde_json::from_str::<Value>(&read(&shown)).unwrap().is_object()),
            Some("toml") => tomls += usize::from(!read(&shown).parse::<toml::Table>().unwrap().is_empty()),
            _ => {}
        }
    }
    assert!(yamls >= 12 && jsons >= 1 && tomls >= 2, "{yamls} {jsons} {tomls}");
}

#[test]
fn a_configuration_that_cannot_be_is_found_by_the_check() {
    let of = |arguments: &[&str]| {
        let output =
            Command::new(env!("CARGO_BIN_EXE_clearance")).arg("serve").args(arguments).arg("--check").output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    assert_eq!(of(&[]).0, Some(0));
    assert_eq!(of(&["--no-such-flag"]).0, Some(2));
    assert_eq!(of(&["--limit", "max_cheese=1"]).0, Some(2));
    assert_eq!(of(&["--config", "/no/such/file"]).0, Some(3));
    assert_eq!(of(&["--config", repository("deploy/clearance.toml").to_str().unwrap()]).0, Some(0));
}

/// Names of metrics in an expression of PromQL: words that begin as all of ours do.
fn named(expression: &str) -> BTreeSet<String> {
    let words = expression.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'));
    words.filter(|word| word.starts_with("clearance_") || word.starts_with("process_")).map(str::to_owned).collect()
}

/// All expressions of the dashboard, of its variables, and of the alerts.
fn expressions() -> Vec<String> {
    let dashboard: Value = serde_json::from_str(&read("deploy/grafana/dashboards/clearance.json")).unwrap();
    let mut expressions = Vec::new();
    for panel in dashboard["panels"].as_array().unwrap() {
        for target in panel["targets"].as_array().into_iter().flatten() {
            expressions.push(target["expr"].as_str().unwrap().to_owned());
        }
    }
    for variable in dashboard["templating"]["list"].as_array().unwrap() {
        expressions.push(variable["query"]["query"].as_str().unwrap().to_owned());
    }
    for group in one("deploy/prometheus/alerts.yml")["groups"].as_array().unwrap() {
        for rule in group["rules"].as_array().unwrap() {
            expressions.push(rule["expr"].as_str().unwrap().to_owned());
        }
    }
    expressions
}

#[tokio::test(flavor = "multi_thread")]
async fn every_metric_of_dashboard_alerts_and_page_is_told_and_every_one_that_is_told_is_explained() {
    let (daemon, watch) = well_used().await;
    let scrape = Scrape::of(&daemon);
    drop(watch);
    let told = scrape.names();
    let expressions = expressions();
    assert!(expressions.len() > 50, "only {} expressions were found", expressions.len());
    let asked: BTreeSet<String> = expressions.iter().flat_map(|expression| named(expression)).collect();
    let missing: Vec<_> = asked.iter().filter(|name| !told.contains(*name)).collect();
    assert!(missing.is_empty(), "nobody tells {missing:?}");
    // Labels in the alerts and the dashboard are labels that are told.
    for label in ["limit=\"max_queries_in_flight\"", "outcome=\"ok\""] {
        assert!(scrape.samples.keys().any(|sample| sample.contains(label)), "{label}");
    }
    let page = read("docs/operations.md");
    let rows: BTreeSet<&str> =
        page.lines().filter_map(|line| line.strip_prefix("| `")?.split_once('`')).map(|(name, _)| name).collect();
    let unexplained: Vec<_> = scrape.types.keys().filter(|family| !rows.contains(family.as_str())).collect();
    assert!(unexplained.is_empty(), "docs/operations.md lacks {unexplained:?}");
    let is_metric = |row: &&&str| row.starts_with("clearance_") || row.starts_with("process_");
    let stale: Vec<_> = rows.iter().filter(is_metric).filter(|row| !scrape.types.contains_key(**row)).collect();
    assert!(stale.is_empty(), "docs/operations.md explains {stale:?}, which nobody tells");
}

#[test]
fn a_metric_that_nobody_tells_would_be_found() {
    let names =
        named("sum by (le) (rate(clearance_call_wait_seconds_bucket{door=\"grpc\"}[5m])) / process_cpu_seconds_total");
    assert_eq!(names, ["clearance_call_wait_seconds_bucket", "process_cpu_seconds_total"].map(str::to_owned).into());
    assert_eq!(named("up == 0"), BTreeSet::new());
}

#[test]
fn the_container_of_compose_is_started_as_the_program_takes_it() {
    let compose = one("deploy/compose.yaml");
    let daemon = &compose["services"]["clearance"];
    check(&strings(&daemon["command"]), "deploy/clearance.toml");
    let help = help();
    for variable in daemon["environment"].as_object().unwrap().keys() {
        assert!(help.contains(&format!("[env: {variable}=")), "{variable}");
    }
    // What is published is what listens, and on loopback alone.
    let ports = strings(&daemon["ports"]);
    assert!(ports.iter().all(|port| port.starts_with("127.0.0.1:")), "{ports:?}");
    assert!(strings(&daemon["command"]).contains(&"--grpc-address=0.0.0.0:50551".to_owned()));
    assert_eq!(ports, ["127.0.0.1:50551:50551"]);
    let prometheus = one("deploy/prometheus/prometheus.yml");
    let target = &prometheus["scrape_configs"][0]["static_configs"][0]["targets"][0];
    assert_eq!(target, "clearance:9464");
    assert!(strings(&daemon["command"]).contains(&"--metrics-address=0.0.0.0:9464".to_owned()));
    let seconds = |text: &str| text.strip_suffix('s').unwrap().parse::<u64>().unwrap();
    assert!(seconds(daemon["stop_grace_period"].as_str().unwrap()) > clearance::app::defaults::DRAIN_SECONDS);
    // Files that are mounted are there.
    for service in ["prometheus", "grafana", "envoy"] {
        for mount in strings(&compose["services"][service]["volumes"]) {
            let from = mount.split(':').next().unwrap();
            // The certificate is the operator's.
            if let Some(path) = from.strip_prefix("./").filter(|path| *path != "envoy/tls") {
                assert!(repository("deploy").join(path).exists(), "{mount}");
            }
        }
    }
}

#[test]
fn the_unit_of_systemd_is_started_as_the_program_takes_it() {
    let unit = read("deploy/systemd/clearance.service");
    let of = |key: &str| {
        let line = unit.lines().find_map(|line| line.strip_prefix(&format!("{key}=")));
        line.unwrap_or_else(|| panic!("{key} is not said")).to_owned()
    };
    let start: Vec<String> = of("ExecStart").split(' ').map(str::to_owned).collect();
    assert_eq!(start[0], "/usr/local/bin/clearance");
    check(&start[1..], "deploy/clearance.toml");
    // `Type=notify` is for a program that says so: tried below.
    assert_eq!((of("Type").as_str(), of("DynamicUser").as_str()), ("notify", "yes"));
    assert!(of("TimeoutStopSec").parse::<u64>().unwrap() > clearance::app::defaults::DRAIN_SECONDS);
    assert_eq!(of("RestartPreventExitStatus"), "2 3");
}

#[test]
fn the_service_manager_is_told_when_the_daemon_is_ready_and_when_it_ends() {
    use std::os::unix::net::UnixDatagram;
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("notify");
    let socket = UnixDatagram::bind(&path).unwrap();
    socket.set_read_timeout(Some(crate::daemon::PATIENCE)).unwrap();
    let receive = || {
        let mut buffer = [0; 256];
        let length = socket.recv(&mut buffer).unwrap();
        String::from_utf8(buffer[..length].to_vec()).unwrap()
    };
    let mut command = crate::daemon::serve();
    let daemon =
        crate::daemon::Daemon::run(command.args(["--metrics-address", "127.0.0.1:0"]).env("NOTIFY_SOCKET", &path));
    assert_eq!(receive().trim(), "READY=1");
    assert_eq!(daemon.stop().0, Some(0));
    assert_eq!(receive().trim(), "STOPPING=1");
}

#[test]
fn the_manifests_of_kubernetes_fit_the_program_and_one_another() {
    let kustomization = one("deploy/kubernetes/kustomization.yaml");
    let resources = strings(&kustomization["resources"]);
    let documents: Vec<Value> = resources.iter().flat_map(|file| yaml(&format!("deploy/kubernetes/{file}"))).collect();
    let named = |kind: &str, name: &str| {
        let found = documents.iter().find(|it| it["kind"] == kind && it["metadata"]["name"] == name);
        found.unwrap_or_else(|| panic!("no {kind} {name}"))
    };
    for generator in kustomization["configMapGenerator"].as_array().unwrap() {
        for file in strings(&generator["files"]) {
            let file = file.rsplit('=').next().unwrap().to_owned();
            assert!(repository("deploy/kubernetes").join(&file).exists(), "{file}");
        }
    }
    let set = named("StatefulSet", "clearance");
    let pod = &set["spec"]["template"]["spec"];
    let container = &pod["containers"][0];
    check(&strings(&container["args"]), "deploy/kubernetes/clearance.toml");
    // Scenes are in memory: a second replica is another world.
    assert_eq!(set["spec"]["replicas"], 1);

    let config: toml::Table = read("deploy/kubernetes/clearance.toml").parse().unwrap();
    let drain = config["drain_seconds"].as_integer().unwrap();
    assert!(pod["terminationGracePeriodSeconds"].as_i64().unwrap() > drain);
    let port = |address: &toml::Value| address.as_str().unwrap().rsplit(':').next().unwrap().parse::<u64>().unwrap();
    let listens = [("grpc", port(&config["grpc"]["address"])), ("metrics", port(&config["metrics"]["address"]))];
    for (name, port) in listens {
        let open = container["ports"].as_array().unwrap().iter().find(|open| open["name"] == name).unwrap();
        assert_eq!(open["containerPort"], port);
    }
    for (probe, path) in [("startupProbe", "/readyz"), ("readinessProbe", "/readyz"), ("livenessProbe", "/livez")] {
        let asked = &container[probe]["httpGet"];
        assert_eq!((&asked["path"], &asked["port"]), (&path.into(), &"metrics".into()));
    }
    // Files that the configuration names are mounted.
    let mounts: Vec<_> =
        container["volumeMounts"].as_array().unwrap().iter().map(|it| it["mountPath"].as_str().unwrap()).collect();
    let tls = &config["grpc"]["tls"];
    let tokens = config["grpc"]["tokens"].as_array().unwrap();
    for file in [&tls["certificate"], &tls["key"]].into_iter().chain(tokens.iter().map(|token| &token["file"])) {
        let folder = Path::new(file.as_str().unwrap()).parent().unwrap().to_str().unwrap();
        assert!(mounts.contains(&folder), "{folder} is not mounted");
    }
    // Selectors select what is there.
    let labels = &set["spec"]["template"]["metadata"]["labels"];
    let selects = |selector: &Value| selector["app.kubernetes.io/name"] == labels["app.kubernetes.io/name"];
    assert!(selects(&set["spec"]["selector"]["matchLabels"]));
    for (kind, name, path) in [
        ("Service", "clearance", "/spec/selector"),
        ("Service", "clearance-shards", "/spec/selector"),
        ("PodDisruptionBudget", "clearance", "/spec/selector/matchLabels"),
        ("NetworkPolicy", "clearance", "/spec/podSelector/matchLabels"),
    ] {
        assert!(selects(named(kind, name).pointer(path).unwrap()), "{kind} {name}");
    }
    assert_eq!(set["spec"]["serviceName"], "clearance-shards");
    // Both run as nobody, with nothing.
    for pod in [pod, &named("Deployment", "envoy")["spec"]["template"]["spec"]] {
        assert_eq!(pod["securityContext"]["runAsNonRoot"], true);
        let own = &pod["containers"][0]["securityContext"];
        assert_eq!((&own["readOnlyRootFilesystem"], &own["allowPrivilegeEscalation"]), (&true.into(), &false.into()));
        assert_eq!(own["capabilities"]["drop"][0], "ALL");
        assert!(pod["containers"][0]["resources"]["limits"]["memory"].is_string());
    }
}

#[test]
fn envoy_comes_to_where_the_daemon_is_and_is_the_same_in_kubernetes_but_for_the_cluster() {
    let (own, in_kubernetes) = (one("deploy/envoy/envoy.yaml"), one("deploy/kubernetes/envoy-config.yaml"));
    let listeners = |config: &Value| config["static_resources"]["listeners"].clone();
    assert_eq!(listeners(&own), listeners(&in_kubernetes));
    let endpoint = |config: &Value| {
        let cluster = &config["static_resources"]["clusters"][0];
        assert!(cluster["health_checks"][0]["grpc_health_check"].is_object());
        let endpoint = &cluster["load_assignment"]["endpoints"][0]["lb_endpoints"][0]["endpoint"];
        endpoint["address"]["socket_address"].clone()
    };
    let default = clearance::app::defaults::GRPC_ADDRESS.rsplit(':').next().unwrap().parse::<u64>().unwrap();
    for (config, host) in [(&own, "clearance"), (&in_kubernetes, "clearance-0.clearance-shards")] {
        assert_eq!(endpoint(config)["address"], host);
        assert_eq!(endpoint(config)["port_value"], default);
    }
    let tls = in_kubernetes["static_resources"]["clusters"][0]["transport_socket"]["name"].as_str().unwrap();
    assert_eq!(tls, "envoy.transport_sockets.tls");
}

#[test]
fn the_dockerfile_copies_what_is_there_and_all_that_the_build_needs() {
    let text = read("deploy/Dockerfile");
    let copied: Vec<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("COPY ").filter(|rest| !rest.starts_with("--from")))
        .flat_map(|rest| rest.split(' ').collect::<Vec<_>>().split_last().map(|(_, from)| from.to_vec()).unwrap())
        .collect();
    for path in &copied {
        assert!(repository(path).exists(), "{path}");
    }
    // What the manifest and the build script name.
    let manifest: toml::Table = read("Cargo.toml").parse().unwrap();
    let mut needed = vec!["src".to_owned(), "proto".to_owned(), "Cargo.lock".to_owned()];
    for kind in ["bench", "test", "example"] {
        for target in manifest.get(kind).and_then(toml::Value::as_array).into_iter().flatten() {
            let default = format!("{kind}s/x.rs");
            let path = target.get("path").and_then(toml::Value::as_str).unwrap_or(&default);
            needed.push(path.split('/').next().unwrap().replace("benchs", "benches"));
        }
    }
    needed.push(manifest["package"]["build"].as_str().unwrap().to_owned());
    for path in &needed {
        assert!(copied.contains(&path.as_str()), "{path} is not copied");
    }
    // What is not ignored is what is copied.
    let ignored = read("deploy/Dockerfile.dockerignore");
    for path in &copied {
        assert!(ignored.lines().any(|line| line == format!("!{path}")), "{path} is ignored");
    }
    assert!(text.contains("USER 10001:10001"));
    let command: Vec<String> =
        serde_json::from_str(text.lines().find_map(|line| line.strip_prefix("CMD ")).unwrap()).unwrap();
    check(&command, "deploy/clearance.toml");
}
