//! Access control: the token must be correct, and the request must not come from another site's page.
//!
//! A browser sends requests of any page to any address, including this one. So a request is rejected unless its `Host`
//! is the address on which the server listens (which a site cannot fake by changing its DNS records), and unless its
//! `Origin`, if present, is the same. The files of the page are not secret; the page itself and the socket need the
//! token.

use std::net::{IpAddr, SocketAddr};

use super::http::Head;

/// The number of hexadecimal digits of a token.
const TOKEN: usize = 32;

/// Returns whether a text can be a token.
fn is_token(text: &str) -> bool {
    text.len() == TOKEN && text.bytes().all(|byte| matches!(byte, b'0'..=b'9' | b'a'..=b'f'))
}

/// The credentials that a client needs.
#[derive(Debug)]
pub(super) struct Gate {
    address: SocketAddr,
    token: String,
}

/// The reason for rejecting a client.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The request names another host.
    Host,
    /// The request comes from another site's page.
    Origin,
    /// The token is wrong or missing.
    Token,
}

impl Refusal {
    /// The reason as text.
    pub(super) const fn why(self) -> &'static str {
        match self {
            Self::Host => "a request for another host was refused",
            Self::Origin => "a request from another site's page was refused",
            Self::Token => "a request with a wrong token was refused",
        }
    }
}

impl Gate {
    /// Creates a gate for the address on which the server listens, with an earlier token or a new one.
    pub(super) fn new(address: SocketAddr, kept: Option<&str>) -> Result<Self, getrandom::Error> {
        let token = match kept.filter(|token| is_token(token)) {
            Some(token) => token.to_owned(),
            None => {
                let mut bytes = [0; TOKEN / 2];
                getrandom::fill(&mut bytes)?;
                bytes.iter().map(|byte| format!("{byte:02x}")).collect()
            }
        };
        Ok(Self { address, token })
    }

    pub(super) fn token(&self) -> &str {
        &self.token
    }

    /// The URL of the page.
    pub(super) fn url(&self) -> String {
        let mut address = self.address;
        if address.ip().is_unspecified() {
            // The unspecified address: the loopback address is one of those it covers.
            address.set_ip(match address.ip() {
                IpAddr::V4(_) => IpAddr::from([127, 0, 0, 1]),
                IpAddr::V6(_) => std::net::Ipv6Addr::LOCALHOST.into(),
            });
        }
        format!("http://{address}/?token={}", self.token)
    }

    /// Checks whether a request is allowed.
    pub(super) fn check(&self, head: &Head) -> Result<(), Refusal> {
        let host = head.header("host").unwrap_or_default();
        if !self.is_ours(host) {
            return Err(Refusal::Host);
        }
        if let Some(origin) = head.header("origin")
            && origin.strip_prefix("http://") != Some(host)
        {
            return Err(Refusal::Origin);
        }
        let needs_token = matches!(head.path(), "/" | "/socket");
        let token = head.query("token").unwrap_or_default();
        if needs_token && !is_same(token.as_bytes(), self.token.as_bytes()) {
            return Err(Refusal::Token);
        }
        Ok(())
    }

    /// Returns whether a host is this server. A server that listens for other computers cannot know the name by which
    /// they call it, but requiring a numeric address excludes sites that change their DNS records.
    fn is_ours(&self, host: &str) -> bool {
        let port = self.address.port();
        let name = host.strip_suffix(&format!(":{port}")).unwrap_or(if port == 80 { host } else { "" });
        let address = name.trim_start_matches('[').trim_end_matches(']').parse::<IpAddr>();
        match address {
            Ok(address) if self.address.ip().is_loopback() => address.is_loopback(),
            Ok(_) => true,
            Err(_) => name == "localhost",
        }
    }
}

/// Compares in constant time.
fn is_same(one: &[u8], other: &[u8]) -> bool {
    one.len() == other.len() && one.iter().zip(other).fold(0, |sum, (a, b)| sum | (a ^ b)) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks a request at a gate; `TOKEN` is the right one.
    fn check(path: &str, headers: &str) -> Result<(), Refusal> {
        let gate = Gate::new("127.0.0.1:8067".parse().expect("an address"), None).expect("random numbers");
        let path = path.replace("TOKEN", &gate.token);
        let text = format!("GET {path} HTTP/1.1\r\n{headers}\r\n");
        gate.check(&Head::parse(text.as_bytes()).expect("it is HTTP"))
    }

    #[test]
    fn a_token_is_kept_only_if_it_is_one() {
        let address = "127.0.0.1:8067".parse().expect("an address");
        let token = |kept| Gate::new(address, Some(kept)).expect("random numbers").token().to_owned();
        let kept = "0123456789abcdef0123456789abcdef";
        assert_eq!(token(kept), kept);
        assert!(["", "1234", "0123456789ABCDEF0123456789ABCDEF"].iter().all(|text| token(text) != **text));
    }

    #[test]
    fn only_the_page_itself_is_admitted() {
        let host = "Host: 127.0.0.1:8067\r\n";
        assert_eq!(check("/?token=TOKEN", host), Ok(()));
        assert_eq!(check("/socket?x=1&token=TOKEN", host), Ok(()));
        assert_eq!(check("/main.js", host), Ok(()));
        assert_eq!(check("/", host), Err(Refusal::Token));
        assert_eq!(check("/?token=", host), Err(Refusal::Token));
        assert_eq!(check("/socket?token=0123", host), Err(Refusal::Token));
        assert_eq!(check("/?token=TOKEN", ""), Err(Refusal::Host));
        assert_eq!(check("/?token=TOKEN", "Host: evil.example:8067\r\n"), Err(Refusal::Host));
        assert_eq!(check("/?token=TOKEN", "Host: 127.0.0.1\r\n"), Err(Refusal::Host));
        assert_eq!(check("/?token=TOKEN", "Host: localhost:8067\r\n"), Ok(()));
        let from = |origin: &str| check("/socket?token=TOKEN", &format!("{host}Origin: {origin}\r\n"));
        assert_eq!(from("http://127.0.0.1:8067"), Ok(()));
        assert_eq!(from("http://evil.example"), Err(Refusal::Origin));
        assert_eq!(from("null"), Err(Refusal::Origin));
        assert_eq!(from("https://127.0.0.1:8067"), Err(Refusal::Origin));
    }
}
