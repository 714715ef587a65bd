//! How does the daemon stand in zenoh's network? What zenoh is told, and what is refused before it is told.

use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

use serde_json::{Value, json};

use super::keys::{BadPrefix, Keys};
use crate::limits::Limits;

/// What can be chosen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Config {
    /// What the daemon's keys begin with.
    pub prefix: String,
    /// Endpoints where others connect, for example `tcp/127.0.0.1:50552`; `None`: those of the file, else [`Config::listens_at`].
    pub listen: Option<Vec<String>>,
    /// Where the daemon listens if neither is said.
    pub listens_at: String,
    /// Endpoints of routers that the daemon connects to; `None`: those of the file.
    pub connect: Option<Vec<String>>,
    /// Look for others by multicast and gossip.
    pub scouting: bool,
    /// zenoh's own configuration, for everything else (JSON5).
    pub file: Option<PathBuf>,
    /// Let strangers in.
    pub insecure: bool,
}

/// Why the configuration cannot be.
#[derive(Debug, thiserror::Error)]
pub enum BadConfig {
    /// The prefix.
    #[error(transparent)]
    Prefix(#[from] BadPrefix),
    /// The file cannot be read, or is no configuration of zenoh.
    #[error("zenoh.file {path}: {problem}", path = path.display())]
    File {
        /// Which.
        path: PathBuf,
        /// What zenoh says.
        problem: String,
    },
    /// A text that is no endpoint.
    #[error("zenoh.{key}: {endpoint:?} is no endpoint such as tcp/127.0.0.1:50552")]
    NoEndpoint {
        /// `listen` or `connect`.
        key: &'static str,
        /// As it was given.
        endpoint: String,
    },
    /// Strangers could come in, or read along.
    #[error("zenoh.{key}: {endpoint} is not on loopback; {remedy}, or say --insecure")]
    Exposed {
        /// `listen` or `connect`.
        key: &'static str,
        /// As it was given.
        endpoint: String,
        /// What would make it safe.
        remedy: &'static str,
    },
    /// zenoh does not take a value.
    #[error("zenoh: {key} = {value}: {problem}")]
    Refused {
        /// zenoh's key.
        key: &'static str,
        /// Its value.
        value: String,
        /// What zenoh says.
        problem: String,
    },
}

/// Of a message, beside its payload.
const MESSAGE_HEAD: usize = 64 << 10;

impl Config {
    /// On any free port of loopback, for whoever is told the port.
    #[must_use]
    pub fn on_loopback(prefix: &str) -> Self {
        Self {
            prefix: prefix.to_owned(),
            listen: None,
            listens_at: "tcp/127.0.0.1:0".to_owned(),
            connect: None,
            scouting: false,
            file: None,
            insecure: false,
        }
    }

    /// The keys.
    ///
    /// # Errors
    /// [`BadConfig::Prefix`].
    pub fn keys(&self) -> Result<Keys, BadConfig> {
        Ok(Keys::new(&self.prefix)?)
    }

    /// What zenoh is told.
    ///
    /// # Errors
    /// [`BadConfig`].
    pub fn of_zenoh(&self, limits: &Limits) -> Result<zenoh::Config, BadConfig> {
        let mut config = match &self.file {
            None => zenoh::Config::default(),
            Some(path) => zenoh::Config::from_file(path)
                .map_err(|error| BadConfig::File { path: path.clone(), problem: error.to_string() })?,
        };
        let own = self.listen.clone().or_else(|| is_unsaid(&config).then(|| vec![self.listens_at.clone()]));
        if let Some(listen) = own {
            tell(&mut config, "listen/endpoints", json!(listen))?;
        }
        if let Some(connect) = &self.connect {
            tell(&mut config, "connect/endpoints", json!(connect))?;
        }
        tell(&mut config, "scouting/multicast/enabled", json!(self.scouting))?;
        tell(&mut config, "scouting/gossip/enabled", json!(self.scouting))?;
        if self.file.is_none() {
            tell(&mut config, "mode", json!("peer"))?;
            tell(
                &mut config,
                "connect/retry",
                json!({"period_init_ms": 100, "period_max_ms": 2000, "period_increase_factor": 2}),
            )?;
        }
        tell(&mut config, "transport/link/rx/max_message_size", json!(limits.max_message_bytes + MESSAGE_HEAD))?;
        tell(&mut config, "transport/unicast/max_sessions", json!(limits.max_connections))?;
        if !self.insecure {
            check_exposure(&config)?;
        }
        Ok(config)
    }
}

fn tell(config: &mut zenoh::Config, key: &'static str, value: Value) -> Result<(), BadConfig> {
    let value = value.to_string();
    config.insert_json5(key, &value).map_err(|error| BadConfig::Refused { key, value, problem: error.to_string() })
}

fn read(config: &zenoh::Config, key: &str) -> Value {
    config.get_json(key).ok().and_then(|text| serde_json::from_str(&text).ok()).unwrap_or_default()
}

/// Whether nobody has said where to listen: zenoh's own default is every address of the machine.
fn is_unsaid(config: &zenoh::Config) -> bool {
    let key = "listen/endpoints";
    read(config, key) == read(&zenoh::Config::default(), key)
}

/// Every text in a value: endpoints come as lists, or as lists for each mode.
fn texts(value: &Value) -> Vec<String> {
    match value {
        Value::String(text) => vec![text.clone()],
        Value::Array(values) => values.iter().flat_map(texts).collect(),
        Value::Object(fields) => fields.values().flat_map(texts).collect(),
        Value::Null | Value::Bool(_) | Value::Number(_) => Vec::new(),
    }
}

/// Beyond loopback everything is encrypted, and those who come in are known.
fn check_exposure(config: &zenoh::Config) -> Result<(), BadConfig> {
    let known = read(config, "transport/link/tls/enable_mtls") == json!(true)
        || read(config, "transport/auth/usrpwd/dictionary_file").is_string();
    let listeners = texts(&read(config, "listen/endpoints")).into_iter().map(|endpoint| ("listen", endpoint));
    let routers = texts(&read(config, "connect/endpoints")).into_iter().map(|endpoint| ("connect", endpoint));
    for (key, endpoint) in listeners.chain(routers) {
        let (protocol, address) =
            endpoint.split_once('/').ok_or_else(|| BadConfig::NoEndpoint { key, endpoint: endpoint.clone() })?;
        let encrypted = matches!(protocol, "tls" | "quic" | "wss");
        let remedy = match key {
            "connect" if encrypted => continue,
            "connect" => "use tls/",
            _ if encrypted && known => continue,
            _ => "use tls/ with client certificates or passwords (zenoh.file)",
        };
        if !is_local(protocol, address) {
            return Err(BadConfig::Exposed { key, endpoint, remedy });
        }
    }
    Ok(())
}

/// Whether an endpoint is of this machine alone.
fn is_local(protocol: &str, address: &str) -> bool {
    if matches!(protocol, "unixsock-stream" | "unixpipe" | "vsock") {
        return true;
    }
    let address = address.split(['?', '#']).next().unwrap_or_default();
    let host = address.rsplit_once(':').map_or(address, |(host, _)| host);
    let loopback = |ip: IpAddr| ip.is_loopback();
    host == "localhost"
        || host.parse().is_ok_and(loopback)
        || address.parse().is_ok_and(|address: SocketAddr| loopback(address.ip()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn config() -> Config {
        Config::on_loopback("clearance")
    }

    fn told(config: &Config) -> Result<zenoh::Config, String> {
        config.of_zenoh(&Limits::default()).map_err(|error| error.to_string())
    }

    #[test]
    fn nobody_is_looked_for_unless_asked() {
        let quiet = told(&config()).unwrap();
        for kind in ["multicast", "gossip"] {
            assert_eq!(read(&quiet, &format!("scouting/{kind}/enabled")), json!(false));
        }
        assert_eq!(texts(&read(&quiet, "listen/endpoints")), ["tcp/127.0.0.1:0"]);
        let looking = told(&Config { scouting: true, ..config() }).unwrap();
        assert_eq!(read(&looking, "scouting/multicast/enabled"), json!(true));
    }

    #[test]
    fn the_file_says_what_flags_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("zenoh.json5");
        std::fs::write(
            &file,
            "{ listen: { endpoints: ['tcp/127.0.0.1:7'] }, scouting: { multicast: { enabled: true } } }",
        )
        .unwrap();
        let of = |listen| told(&Config { listen, file: Some(file.clone()), ..config() }).unwrap();
        assert_eq!(texts(&read(&of(None), "listen/endpoints")), ["tcp/127.0.0.1:7"]);
        assert_eq!(texts(&read(&of(Some(Vec::new())), "listen/endpoints")), Vec::<String>::new());
        assert_eq!(read(&of(None), "scouting/multicast/enabled"), json!(false));
        std::fs::write(&file, "{ mode: 'boss' }").unwrap();
        let error = told(&Config { file: Some(file.clone()), ..config() }).unwrap_err();
        assert!(error.starts_with(&format!("zenoh.file {}: ", file.display())), "{error}");
    }

    #[test]
    fn strangers_stay_outside() {
        let listen = |endpoint: &str| told(&Config { listen: Some(vec![endpoint.to_owned()]), ..config() });
        for local in
            ["tcp/127.0.0.1:1", "tcp/[::1]:1", "tcp/localhost:1", "unixsock-stream//run/z", "tcp/127.0.0.1:1#iface=lo"]
        {
            assert!(listen(local).is_ok(), "{local}");
        }
        for open in ["tcp/0.0.0.0:1", "tcp/[::]:1", "tls/0.0.0.0:1", "tcp/127.0.0.1.example.com:1", "tcp/10.0.0.1:1"] {
            assert!(listen(open).unwrap_err().contains("is not on loopback; use tls/ with client cert"), "{open}");
        }
        let connect = |endpoint: &str| told(&Config { connect: Some(vec![endpoint.to_owned()]), ..config() });
        assert!(connect("tls/router.example:7447").is_ok());
        assert!(connect("tcp/router.example:7447").unwrap_err().contains("is not on loopback; use tls/, or"));
        let insecure = Config { listen: Some(vec!["tcp/0.0.0.0:1".to_owned()]), insecure: true, ..config() };
        assert!(told(&insecure).is_ok());
        let file = tempfile::NamedTempFile::with_suffix(".json5").unwrap();
        std::fs::write(file.path(), "{ transport: { link: { tls: { enable_mtls: true } } } }").unwrap();
        let listen = Some(vec!["tls/0.0.0.0:1".to_owned()]);
        assert!(told(&Config { listen, file: Some(file.path().to_owned()), ..config() }).is_ok());
    }

    #[test]
    fn what_is_no_endpoint_is_told() {
        let of = |endpoint: &str| told(&Config { listen: Some(vec![endpoint.to_owned()]), ..config() }).unwrap_err();
        assert!(of("nonsense").contains("nonsense"), "{}", of("nonsense"));
    }
}
