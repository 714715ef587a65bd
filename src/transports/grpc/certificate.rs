//! Whose certificate is it, and when is it valid?

use std::fmt::Write;
use std::time::{SystemTime, UNIX_EPOCH};

use sha2::{Digest, Sha256};
use x509_parser::prelude::{FromDer, X509Certificate};

/// The name of a client that showed this certificate: its subject, or the start of its SHA-256 if it has none.
pub(super) fn client_name(der: &[u8]) -> String {
    let subject = X509Certificate::from_der(der).map(|(_, certificate)| certificate.subject().to_string());
    match subject {
        Ok(subject) if !subject.is_empty() => format!("certificate:{subject}"),
        _ => {
            let mut name = "certificate:sha256:".to_owned();
            for byte in &Sha256::digest(der)[..8] {
                // Writing to a string cannot fail.
                write!(name, "{byte:02x}").unwrap_or_default();
            }
            name
        }
    }
}

/// Where `now` is in the time a certificate is valid for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Validity {
    /// It begins at this time.
    NotYet(String),
    /// It ends at this time.
    Valid(String),
    /// It ended at this time.
    Expired(String),
}

/// # Errors
/// What is wrong with the certificate.
pub(super) fn validity(der: &[u8], now: SystemTime) -> Result<Validity, String> {
    let (_, certificate) = X509Certificate::from_der(der).map_err(|error| error.to_string())?;
    let now = now.duration_since(UNIX_EPOCH).map_or(0, |since| i64::try_from(since.as_secs()).unwrap_or(i64::MAX));
    let (from, to) = (certificate.validity().not_before, certificate.validity().not_after);
    Ok(if now < from.timestamp() {
        Validity::NotYet(from.to_string())
    } else if now > to.timestamp() {
        Validity::Expired(to.to_string())
    } else {
        Validity::Valid(to.to_string())
    })
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_certificate_is_valid_between_its_dates_and_named_by_its_subject() {
        let mut parameters = rcgen::CertificateParams::new(vec![]).unwrap();
        parameters.distinguished_name = rcgen::DistinguishedName::new();
        parameters.distinguished_name.push(rcgen::DnType::CommonName, "planner");
        parameters.not_before = rcgen::date_time_ymd(2020, 1, 1);
        parameters.not_after = rcgen::date_time_ymd(2020, 2, 1);
        let key = rcgen::KeyPair::generate().unwrap();
        let der = parameters.self_signed(&key).unwrap().der().to_vec();
        // The first second of 2020.
        let start = UNIX_EPOCH + Duration::from_secs(1_577_836_800);
        let day = |n: u64| validity(&der, start + Duration::from_secs(n * 86_400)).unwrap();
        assert!(matches!(validity(&der, start - Duration::from_secs(1)).unwrap(), Validity::NotYet(_)));
        assert!(matches!(day(0), Validity::Valid(_)));
        assert!(matches!(day(31), Validity::Valid(_)));
        let Validity::Expired(when) = day(32) else { panic!("not expired") };
        assert!(when.contains("2020"), "{when}");
        assert_eq!(client_name(&der), "certificate:CN=planner");
        assert!(validity(b"nonsense", start).is_err());
        assert!(client_name(b"nonsense").starts_with("certificate:sha256:"));
        assert_eq!(client_name(b"nonsense").len(), "certificate:sha256:".len() + 16);
    }
}
