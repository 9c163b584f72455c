//! The command signorini as a child process.
//!
//! ```text
//! start ──▶ child, in the folder, confined to it ──▶ standard output: one object, or a line per event
//!             │                                      standard error: its last bytes are kept
//!             ├── cancelled, or out of time ──▶ SIGINT ──▶ the run stops after its iteration, resumable
//!             └── still there after a while ──▶ SIGKILL
//! ```
//!
//! A panic, a crash or a lack of memory ends the child, never the server. Arguments are a list, no shell reads them.

use crate::limits::Limits;
use crate::reply::{CHECK_DISK, Refusal};
use serde_json::Value;
use std::collections::VecDeque;
use std::ffi::OsString;
use std::path::PathBuf;
use std::process::{ExitStatus, Stdio};
use std::time::Duration;
use tokio::io::{AsyncRead, AsyncReadExt};
use tokio::process::{Child, Command};
use tokio::time::{Instant, sleep_until};

/// The variable that confines the command to a folder.
pub const WITHIN: &str = "SIGNORINI_WITHIN";

/// What to do about a command that broke down.
const BROKEN: &str =
    "call again; if it happens again, it is a fault of signorini or of its installation";

/// Bytes of standard error that are kept.
const TAIL: usize = 4096;

/// The command, and where it runs.
#[derive(Clone, Debug)]
pub struct Program {
    /// The file to run, and the arguments before all others.
    pub words: Vec<OsString>,
    /// The folder that it runs in and is confined to.
    pub folder: PathBuf,
}

/// Why a command was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// The client cancelled its request, or left.
    Cancelled,
    /// Its time was over.
    OutOfTime,
    /// It printed more than it may.
    TooLong,
}

/// How a command ended.
#[derive(Clone, Debug)]
pub struct Ended {
    /// Its exit code; none where a signal ended it.
    pub code: Option<i32>,
    /// How, in words.
    pub status: String,
    /// The end of its standard error.
    pub errors: String,
    /// Whether the server stopped it.
    pub stopped: Option<Stopped>,
}

/// How long a command may take, and who may stop it.
pub struct Watch<'a, F> {
    /// The limits on output.
    pub limits: &'a Limits,
    /// Time that it has.
    pub time: Duration,
    /// Resolves when it is to stop.
    pub cancelled: F,
}

impl Program {
    /// Runs a command to its end and returns what it printed, at most `limits.printed` bytes.
    ///
    /// # Errors
    /// A command that cannot be started.
    pub async fn output(
        &self,
        arguments: &[String],
        watch: Watch<'_, impl Future<Output = ()> + Send>,
    ) -> Result<(Ended, Vec<u8>), Refusal> {
        let mut printed = Vec::new();
        let most = watch.limits.printed;
        let ended = self
            .follow(arguments, watch, |bytes| {
                printed.extend_from_slice(bytes);
                printed.len() <= most
            })
            .await?;
        printed.truncate(most);
        Ok((ended, printed))
    }

    /// Runs a command to its end and hands over every line that it prints. Longer lines than `limits.event` are left out.
    ///
    /// # Errors
    /// A command that cannot be started.
    pub async fn lines(
        &self,
        arguments: &[String],
        watch: Watch<'_, impl Future<Output = ()> + Send>,
        mut hear: impl FnMut(&[u8]) + Send,
    ) -> Result<Ended, Refusal> {
        let mut line = Vec::new();
        let mut is_long = false;
        let most = watch.limits.event;
        self.follow(arguments, watch, |bytes| {
            for part in bytes.split_inclusive(|byte| *byte == b'\n') {
                is_long = is_long || line.len() + part.len() > most;
                if is_long {
                    line.clear();
                } else {
                    line.extend_from_slice(part);
                }
                if part.ends_with(b"\n") {
                    if !is_long {
                        hear(&line);
                    }
                    line.clear();
                    is_long = false;
                }
            }
            true
        })
        .await
    }

    /// Runs a command; `hear` gets what it prints and says whether it may go on.
    async fn follow(
        &self,
        arguments: &[String],
        watch: Watch<'_, impl Future<Output = ()> + Send>,
        mut hear: impl FnMut(&[u8]) -> bool + Send,
    ) -> Result<Ended, Refusal> {
        let command = arguments.first().cloned().unwrap_or_default();
        let failed = |error: std::io::Error| Refusal::Command {
            command: command.clone(),
            why: error.to_string(),
            help: BROKEN,
        };
        let mut child = self.start(arguments).map_err(failed)?;
        let errors = tokio::spawn(tail(child.stderr.take()));
        let mut out = child.stdout.take();
        let mut buffer = vec![0; 16 << 10];
        let mut stopped = None;
        let mut until = Instant::now() + watch.time;
        let mut cancelled = std::pin::pin!(watch.cancelled);
        let status: ExitStatus = loop {
            let wish = tokio::select! {
                () = &mut cancelled, if stopped.is_none() => Some(Stopped::Cancelled),
                () = sleep_until(until) => Some(stopped.unwrap_or(Stopped::OutOfTime)),
                read = read(&mut out, &mut buffer), if out.is_some() => match read {
                    0 => {
                        out = None;
                        None
                    }
                    n => {
                        let goes_on = hear(buffer.get(..n).unwrap_or_default());
                        (!goes_on && stopped.is_none()).then_some(Stopped::TooLong)
                    }
                },
                status = child.wait(), if out.is_none() => break status.map_err(failed)?,
            };
            if let Some(wish) = wish {
                if stopped.is_some() || wish == Stopped::TooLong {
                    let _ = child.start_kill();
                } else {
                    interrupt(&mut child);
                }
                stopped.get_or_insert(wish);
                until = Instant::now() + watch.limits.grace;
            }
        };
        Ok(Ended {
            code: status.code(),
            status: status.to_string(),
            errors: errors.await.unwrap_or_default(),
            stopped,
        })
    }

    fn start(&self, arguments: &[String]) -> std::io::Result<Child> {
        let mut words = self.words.iter();
        let file = words.next().cloned().unwrap_or_default();
        Command::new(file)
            .args(words)
            .args(arguments)
            .current_dir(&self.folder)
            .env(WITHIN, &self.folder)
            .env("NO_COLOR", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .kill_on_drop(true)
            .spawn()
    }
}

/// The next bytes; 0 at the end, and where they cannot be read.
async fn read(from: &mut Option<impl AsyncRead + Unpin>, buffer: &mut [u8]) -> usize {
    match from {
        Some(from) => from.read(buffer).await.unwrap_or(0),
        None => 0,
    }
}

/// The last bytes of a stream, as text.
async fn tail(from: Option<impl AsyncRead + Unpin>) -> String {
    let mut from = from;
    let mut kept: VecDeque<u8> = VecDeque::new();
    let mut buffer = [0; 4096];
    loop {
        match read(&mut from, &mut buffer).await {
            0 => break,
            n => kept.extend(buffer.get(..n).unwrap_or_default()),
        }
        let excess = kept.len().saturating_sub(TAIL);
        kept.drain(..excess);
    }
    let kept: Vec<u8> = kept.into();
    String::from_utf8_lossy(&kept).trim().to_owned()
}

/// Asks a command to stop: a run then ends after its iteration and can be resumed.
#[cfg(unix)]
fn interrupt(child: &mut Child) {
    use rustix::process::{Pid, Signal, kill_process};
    // no id: it has ended already
    let id = child.id().and_then(|id| Pid::from_raw(id.cast_signed()));
    if let Some(id) = id {
        let _ = kill_process(id, Signal::INT);
    }
}

#[cfg(not(unix))]
fn interrupt(child: &mut Child) {
    let _ = child.start_kill();
}

impl Ended {
    /// What went wrong with a command that gave no answer.
    pub fn fault(&self, command: &str) -> Refusal {
        let why = match self.stopped {
            Some(Stopped::Cancelled) => "it was cancelled".to_owned(),
            Some(Stopped::OutOfTime) => "it took too long and was stopped".to_owned(),
            Some(Stopped::TooLong) => "it printed more than is read here".to_owned(),
            None => self.status.clone(),
        };
        let why = if self.errors.is_empty() {
            why
        } else {
            format!("{why}\n{}", self.errors)
        };
        Refusal::Command {
            command: command.to_owned(),
            why,
            help: self.help(),
        }
    }

    /// What to do about it. The exit codes are those of the command: 2 command line, 3 input, 4 model, 6 not written.
    const fn help(&self) -> &'static str {
        match (self.stopped, self.code) {
            (Some(Stopped::Cancelled), _) => "call again when it is wanted",
            (Some(Stopped::OutOfTime), _) => {
                "call it for a smaller case, or outside of this server"
            }
            (Some(Stopped::TooLong), _) => "call it outside of this server",
            (None, Some(2..=4)) => "change the arguments by what the message says",
            (None, Some(6)) => CHECK_DISK,
            (None, _) => BROKEN,
        }
    }
}

/// The one object that a command with `--json` printed.
pub fn object(printed: &[u8]) -> Option<Value> {
    let value: Value = serde_json::from_slice(printed).ok()?;
    value.is_object().then_some(value)
}
