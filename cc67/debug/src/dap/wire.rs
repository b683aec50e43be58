//! Messages on a stream: a header with the length, then JSON.

use std::io::{self, BufRead, Write};

use serde_json::{Value, json};

use crate::debugger::DebugError;

/// The maximum size of a message; a client that announces a larger one is rejected.
const MOST: usize = 64 << 20;

/// The next message; `None` at the end, and after malformed input.
pub(super) fn read(input: &mut impl BufRead) -> Option<Value> {
    let mut length = None;
    loop {
        let mut line = String::new();
        if input.read_line(&mut line).ok()? == 0 {
            return None;
        }
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("Content-Length")
        {
            length = value.trim().parse::<usize>().ok();
        }
    }
    let mut body = vec![0; length.filter(|length| *length <= MOST)?];
    input.read_exact(&mut body).ok()?;
    serde_json::from_slice(&body).ok()
}

/// The output stream to the client.
pub(super) struct ClientWire<W> {
    output: W,
    sequence: u64,
}

impl<W: Write> ClientWire<W> {
    pub(super) const fn new(output: W) -> Self {
        Self { output, sequence: 0 }
    }

    pub(super) fn respond(&mut self, request: &Value, reply: Result<Value, DebugError>) -> io::Result<()> {
        let mut message = json!({
            "type": "response",
            "request_seq": request["seq"],
            "command": request["command"],
            "success": reply.is_ok(),
        });
        match reply {
            Ok(body) => message["body"] = body,
            Err(error) => {
                let text = error.to_string();
                message["message"] = json!(text);
                // Expressions that an editor evaluates by itself, such as the one under the mouse pointer, do not
                // interrupt a run.
                let is_shown = request["command"] != "evaluate";
                message["body"] = json!({ "error": { "id": 1, "format": text, "showUser": is_shown } });
            }
        }
        self.send(message)
    }

    pub(super) fn event(&mut self, name: &str, body: Value) -> io::Result<()> {
        self.send(json!({ "type": "event", "event": name, "body": body }))
    }

    pub(super) fn output(&mut self, category: &str, text: &str) -> io::Result<()> {
        self.event("output", json!({ "category": category, "output": text }))
    }

    /// Passes a message on, with the next sequence number of this stream.
    pub(super) fn forward(&mut self, message: Value) -> io::Result<()> {
        self.send(message)
    }

    fn send(&mut self, mut message: Value) -> io::Result<()> {
        self.sequence += 1;
        message["seq"] = json!(self.sequence);
        write(&mut self.output, &message)
    }
}

/// Writes a message unchanged.
pub(super) fn write(output: &mut impl Write, message: &Value) -> io::Result<()> {
    let text = message.to_string();
    write!(output, "Content-Length: {}\r\n\r\n{text}", text.len())?;
    output.flush()
}

const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

/// Bytes as base64.
pub(super) fn encode(bytes: &[u8]) -> String {
    let mut out = String::new();
    for chunk in bytes.chunks(3) {
        let word =
            chunk.iter().fold(0_u32, |word, byte| word << 8 | u32::from(*byte)) << (8 * (3 - chunk.len()));
        for index in 0..4 {
            let digit = ALPHABET[(word >> (18 - 6 * index) & 63) as usize];
            out.push(if index <= chunk.len() { char::from(digit) } else { '=' });
        }
    }
    out
}

/// The bytes of a base64 text; `None` if it is malformed.
pub(super) fn decode(text: &str) -> Option<Vec<u8>> {
    let mut out = Vec::new();
    let (mut word, mut bits) = (0_u32, 0);
    for byte in text.bytes().filter(|byte| *byte != b'=') {
        let digit = ALPHABET.iter().position(|known| *known == byte)?;
        word = word << 6 | digit as u32;
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((word >> bits) as u8);
            word &= (1 << bits) - 1;
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back_from_base64() {
        for (bytes, text) in
            [(&b""[..], ""), (b"f", "Zg=="), (b"fo", "Zm8="), (b"foo", "Zm9v"), (b"foob", "Zm9vYg==")]
        {
            assert_eq!((encode(bytes).as_str(), decode(text).as_deref()), (text, Some(bytes)));
        }
    }

    #[test]
    fn an_invalid_message_ends_the_reading() {
        for (text, expect) in [
            ("Content-Length: 2\r\n\r\n{}", Some(json!({}))),
            ("Content-Length: 9\r\n\r\n{}", None),
            ("Content-Length: 99999999999\r\n\r\n{}", None),
            ("x\r\n\r\n{}", None),
            ("", None),
        ] {
            assert_eq!(read(&mut text.as_bytes()), expect, "{text}");
        }
    }
}
