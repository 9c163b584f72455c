//! Messages of the client, line by line, before the protocol sees them.
//!
//! ```text
//! standard input ──▶ relay ──▶ lines of at most so many bytes ──▶ rmcp
//!                      │
//!                      └── a longer one: skipped; a short request with its id takes its place, which is answered with an error
//! ```
//!
//! Before the first request, messages that are none are left out: a server that has not been greeted has no use for them.

use serde_json::Value;
use tokio::io::{AsyncBufReadExt, AsyncRead, AsyncWrite, AsyncWriteExt, BufReader};

/// The method that stands for a request that was too long.
pub const TOO_LONG: &str = "signorini/too_long";

/// Bytes that the id of a request may have.
const LONGEST_ID: usize = 128;

/// Copies messages from `from` to `to` until one of them ends; none is longer than `most` bytes.
pub async fn relay(from: impl AsyncRead + Unpin, mut to: impl AsyncWrite + Unpin, most: usize) {
    let mut from = BufReader::new(from);
    let mut line = Vec::new();
    let mut outline = Outline::default();
    let mut is_long = false;
    let mut is_greeted = false;
    loop {
        let Ok(bytes) = from.fill_buf().await else {
            return;
        };
        let end = bytes.iter().position(|byte| *byte == b'\n');
        let n = end.map_or(bytes.len(), |end| end + 1);
        let part = bytes.get(..n).unwrap_or_default();
        outline.read(part);
        is_long = is_long || line.len() + n > most;
        if is_long {
            // gives its memory back, too
            line = Vec::new();
        } else {
            line.extend_from_slice(part);
        }
        from.consume(n);
        if n > 0 && end.is_none() {
            continue;
        }
        let message = std::mem::take(&mut outline);
        if is_long {
            line = message.refused();
        }
        is_greeted = is_greeted || message.is_request();
        if is_greeted && to.write_all(&line).await.is_err() {
            return;
        }
        if n == 0 {
            return;
        }
        line.clear();
        is_long = false;
    }
}

/// What is seen of a message without keeping it: the members `id` and `method` at its top.
#[derive(Debug, Default)]
struct Outline {
    depth: usize,
    in_text: bool,
    is_escaped: bool,
    /// Whether a value comes, not a key.
    is_value: bool,
    key: Vec<u8>,
    id: Vec<u8>,
    has_method: bool,
}

impl Outline {
    fn read(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|byte| self.step(*byte));
    }

    fn step(&mut self, byte: u8) {
        let is_id = self.depth == 1 && self.is_value && self.key == b"\"id\"";
        if self.in_text {
            match byte {
                _ if self.is_escaped => self.is_escaped = false,
                b'\\' => self.is_escaped = true,
                b'"' => self.in_text = false,
                _ => {}
            }
        } else {
            match byte {
                b'"' => self.in_text = true,
                b'{' | b'[' => self.depth += 1,
                b'}' | b']' => self.depth = self.depth.saturating_sub(1),
                b':' if self.depth == 1 => {
                    self.is_value = true;
                    self.has_method = self.has_method || self.key == b"\"method\"";
                    // of a key that comes twice, the last counts
                    if self.key == b"\"id\"" {
                        self.id.clear();
                    }
                    return;
                }
                b',' if self.depth == 1 => {
                    self.is_value = false;
                    self.key.clear();
                    return;
                }
                b' ' | b'\t' | b'\r' | b'\n' => return,
                _ => {}
            }
        }
        if self.depth != 1 {
            return;
        }
        // one byte more than may be, to know what is too long
        if is_id && self.id.len() <= LONGEST_ID {
            self.id.push(byte);
        } else if !self.is_value && byte != b'{' && self.key.len() <= 16 {
            self.key.push(byte);
        }
    }

    /// The id, where it is a text or a number.
    fn id(&self) -> Option<&str> {
        let id = std::str::from_utf8(&self.id).ok()?;
        let is_right = id.starts_with('"') || id.bytes().all(|b| b.is_ascii_digit() || b == b'-');
        let is_json = serde_json::from_str::<Value>(id).is_ok();
        (is_right && is_json && id.len() <= LONGEST_ID).then_some(id)
    }

    fn is_request(&self) -> bool {
        self.has_method && self.id().is_some()
    }

    /// What takes the place of a message that was too long.
    fn refused(&self) -> Vec<u8> {
        match self.id() {
            Some(id) => format!("{{\"jsonrpc\":\"2.0\",\"id\":{id},\"method\":\"{TOO_LONG}\"}}\n")
                .into_bytes(),
            None => Vec::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is passed on of a text.
    fn relayed(text: &str, most: usize) -> String {
        let runtime = tokio::runtime::Builder::new_current_thread().build();
        runtime.unwrap().block_on(async {
            let mut out = Vec::new();
            relay(text.as_bytes(), &mut out, most).await;
            String::from_utf8(out).unwrap()
        })
    }

    const PING: &str = "{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"ping\"}\n";

    #[test]
    fn messages_within_the_limit_pass_unchanged() {
        let odd = "not json\n\n{\"a\":[1,{\"id\":7}]}\r\n";
        let text = format!("{PING}{odd}{PING}");
        assert_eq!(relayed(&text, 100), text);
        assert_eq!(relayed(&format!("{PING}rest"), 100), format!("{PING}rest"));
    }

    #[test]
    fn a_longer_request_becomes_a_short_one_with_its_id() {
        let pad = "x\\\"}]{".repeat(40);
        for id in ["7", "-1", "\"a\\\"b\""] {
            let expected =
                format!("{{\"jsonrpc\":\"2.0\",\"id\":{id},\"method\":\"{TOO_LONG}\"}}\n");
            let first = format!(
                "{{ \"id\" : {id}, \"method\":\"m\",\"params\":{{\"id\":9,\"p\":\"{pad}\"}}}}\n"
            );
            let last =
                format!("{{\"params\":[{{\"id\":9}},\"{pad}\"],\"method\":\"m\",\"id\":{id}}}\n");
            for long in [first, last] {
                let through = relayed(&format!("{long}{PING}"), 100);
                assert_eq!(through, format!("{expected}{PING}"), "{long}");
            }
        }
    }

    #[test]
    fn a_longer_message_without_an_id_is_left_out() {
        let pad = "x".repeat(200);
        for long in [
            format!("{{\"method\":\"m\",\"params\":\"{pad}\"}}\n"),
            format!("{{\"id\":{pad},\"method\":\"m\"}}\n"),
            format!("{{\"id\":[1],\"method\":\"m\",\"p\":\"{pad}\"}}\n"),
            format!("{{\"id\":\"{pad}\",\"method\":\"m\"}}\n"),
            format!("{pad}\n"),
        ] {
            assert_eq!(relayed(&format!("{PING}{long}{PING}"), 100), PING.repeat(2));
        }
    }

    #[test]
    fn what_comes_before_the_first_request_is_left_out() {
        let before = "{\"jsonrpc\":\"2.0\",\"method\":\"note\"}\n{\"id\":1,\"result\":{}}\n[]\nx\n";
        assert_eq!(
            relayed(&format!("{before}{PING}{before}"), 100),
            format!("{PING}{before}")
        );
    }
}
