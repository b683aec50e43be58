//! The part of HTTP that one page needs: the head of a GET request, and a response after which the connection is
//! closed.

use std::io::{self, Read, Write};
use std::net::TcpStream;

use super::files::File;

/// The maximum size of a head in bytes.
const LONGEST: usize = 8 << 10;

/// The head of a request.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Head {
    target: String,
    /// The headers, with names in lower case.
    headers: Vec<(String, String)>,
}

impl Head {
    /// Reads the head of a request from a client; `None` if it is malformed. Data after the head are not read.
    ///
    /// # Errors
    ///
    /// The connection failed, or ended before its first byte: browsers open some in advance.
    pub(super) fn read(stream: &mut TcpStream) -> io::Result<Option<Self>> {
        let mut bytes = Vec::new();
        let mut byte = [0];
        // A head is short, and the data after it belong to the socket.
        while !bytes.ends_with(b"\r\n\r\n") {
            let count = stream.read(&mut byte)?;
            if count == 0 && bytes.is_empty() {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            if count == 0 || bytes.len() == LONGEST {
                return Ok(None);
            }
            bytes.extend(byte);
        }
        Ok(Self::parse(&bytes))
    }

    /// Parses a head.
    pub(super) fn parse(bytes: &[u8]) -> Option<Self> {
        let mut lines = std::str::from_utf8(bytes).ok()?.split("\r\n");
        let target = lines.next()?.strip_prefix("GET ")?.strip_suffix(" HTTP/1.1")?.to_owned();
        let header = |line: &str| {
            let (name, value) = line.split_once(':')?;
            Some((name.to_ascii_lowercase(), value.trim().to_owned()))
        };
        let headers = lines.take_while(|line| !line.is_empty()).map(header).collect::<Option<_>>()?;
        target.starts_with('/').then_some(Self { target, headers })
    }

    /// The requested path.
    pub(super) fn path(&self) -> &str {
        self.target.split('?').next().unwrap_or_default()
    }

    /// The value of a query parameter.
    pub(super) fn query(&self, name: &str) -> Option<&str> {
        let (_, query) = self.target.split_once('?')?;
        query.split('&').find_map(|pair| pair.strip_prefix(name)?.strip_prefix('='))
    }

    /// A header, by its name in lower case; `None` if there is none, or more than one.
    pub(super) fn header(&self, name: &str) -> Option<&str> {
        let mut found = self.headers.iter().filter(|(known, _)| known == name);
        let (_, value) = found.next()?;
        found.next().is_none().then_some(value)
    }

    /// Returns the key of a client that requests a WebSocket, for the response.
    pub(super) fn websocket_key(&self) -> Option<&str> {
        let wants = self.header("upgrade")?.eq_ignore_ascii_case("websocket");
        let is_known = self.header("sec-websocket-version") == Some("13");
        self.header("sec-websocket-key").filter(|_| wants && is_known)
    }
}

/// A response.
#[derive(Debug)]
pub(super) struct HttpAnswer {
    status: &'static str,
    mime: &'static str,
    body: Vec<u8>,
}

impl HttpAnswer {
    /// A file of the page.
    pub(super) fn file(file: &File) -> Self {
        Self { status: "200 OK", mime: file.mime, body: file.text.as_bytes().to_vec() }
    }

    /// Creates a response that reports an error.
    pub(super) fn problem(code: u16, why: &str) -> Self {
        let status = match code {
            400 => "400 Bad Request",
            403 => "403 Forbidden",
            _ => "404 Not Found",
        };
        Self { status, mime: "text/plain; charset=utf-8", body: format!("{why}\n").into_bytes() }
    }

    /// Sends the response.
    pub(super) fn send(&self, stream: &mut TcpStream) -> io::Result<()> {
        let head = format!(
            "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nConnection: close\r\nCache-Control: no-store\r\n\
             Content-Security-Policy: default-src 'none'; script-src 'self'; style-src 'self'; connect-src 'self'; \
             img-src 'self' data: blob:; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n\
             X-Content-Type-Options: nosniff\r\nReferrer-Policy: no-referrer\r\n\
             Cross-Origin-Resource-Policy: same-origin\r\n\r\n",
            self.status,
            self.mime,
            self.body.len()
        );
        stream.write_all(&[head.as_bytes(), &self.body].concat())?;
        stream.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_request_head_is_parsed() {
        let text = b"GET /socket?a=1&token=x HTTP/1.1\r\nHost: here\r\nUpgrade: WebSocket\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: k\r\n\r\n";
        let head = Head::parse(text).expect("it is HTTP");
        assert_eq!(
            (head.path(), head.query("token"), head.header("host")),
            ("/socket", Some("x"), Some("here"))
        );
        assert_eq!(head.websocket_key(), Some("k"));
        let wrong: [&[u8]; 5] = [
            b"",
            b"POST / HTTP/1.1\r\n\r\n",
            b"GET / HTTP/1.0\r\n\r\n",
            b"GET / HTTP/1.1\r\nHost\r\n\r\n",
            b"GET \xff HTTP/1.1\r\n\r\n",
        ];
        assert!(wrong.iter().all(|text| Head::parse(text).is_none()));
    }
}
