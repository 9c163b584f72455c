//! The tool that solves.

use super::changes;
use super::results::{contacts_text, expectations_text};
use crate::Server;
use crate::account::Account;
use crate::program::{Ended, Stopped, Watch};
use crate::reply::{Refusal, Reply, diagnostics_text};
use crate::root::Place;
use rmcp::handler::server::wrapper::Parameters;
use rmcp::model::{ProgressNotificationParam, ProgressToken};
use rmcp::schemars::{self, JsonSchema};
use rmcp::service::RequestContext;
use rmcp::{Peer, RoleServer, tool, tool_router};
use serde::Deserialize;
use serde_json::{Value, json};
use std::time::Duration;
use tokio::sync::mpsc::{Receiver, channel};

/// Reports of progress that wait for a client at most.
const REPORTS: usize = 16;

/// What to run.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// The case (.toml) or deck (.inp, .in), relative to the folder of the server. With `resume`: the folder of results to go on with.
    path: String,
    /// The folder for the results. Default: next to the case, with `.out` in place of its extension.
    output: Option<String>,
    /// Number of threads; results do not depend on it. Default: as the case says, or one per core.
    threads: Option<u16>,
    /// Seconds after which the run stops, resumable. Default: 600.
    max_wall: Option<f64>,
    /// Changes for this run, as KEY=VALUE: `material.steel.E=2000`. The file stays as it is.
    #[serde(default)]
    set: Vec<String>,
    /// Start even where the folder has results of another case, which are then removed.
    #[serde(default)]
    fresh: bool,
    /// Go on with a run that was stopped, from its last checkpoint: `path` is then the folder of its results.
    #[serde(default)]
    resume: bool,
}

#[tool_router(router = run_tools, vis = "pub(crate)")]
impl Server {
    /// Solves a case and returns when it has ended: status, exit code, messages, expectations, and the summary with forces, areas and
    /// pressures of every contact. Reports progress while it goes on. Cancelling the request, or `max_wall`, stops the run after its
    /// present iteration; what had converged is on disk, and `resume` goes on from there.
    ///
    /// Exit codes: 0 solved, 1 an expectation failed, 2 command line, 3 input, 4 ill-posed model, 5 not converged, 6 not written, 7 cannot
    /// resume, 8 limit reached, 70 internal error, 130 interrupted.
    #[tool(annotations(
        title = "Run a case",
        read_only_hint = false,
        destructive_hint = true,
        open_world_hint = false
    ))]
    async fn run(
        &self,
        Parameters(wanted): Parameters<Run>,
        context: RequestContext<RoleServer>,
    ) -> Result<Reply, Refusal> {
        let wall = self.wall(wanted.max_wall)?;
        let (arguments, results) = self.run_arguments(&wanted, wall)?;
        let _permit = self.run_permit()?;
        let (reports, heard) = channel(REPORTS);
        let reporter = tokio::spawn(pass_on(
            heard,
            context.peer.clone(),
            context.meta.get_progress_token(),
        ));
        let mut account = Account::default();
        let most = self.limits().diagnostics;
        let watch = Watch {
            limits: self.limits(),
            // the run stops by itself before
            time: wall + self.limits().grace,
            cancelled: self.cancelled(&context),
        };
        let ended = self
            .program()
            .lines(&arguments, watch, |line| {
                if let Some(report) = account.hear(line, most) {
                    // a client that is slow to read gets fewer
                    let _ = reports.try_send(report);
                }
            })
            .await;
        // no report comes after the result
        drop(reports);
        let _ = reporter.await;
        let ended = ended?;
        self.outcome(&account, &ended, &results)
    }
}

impl Server {
    /// The command line of a run, and the folder of its results.
    fn run_arguments(&self, wanted: &Run, wall: Duration) -> Result<(Vec<String>, Place), Refusal> {
        let changes = changes(&wanted.set, self.limits())?;
        let mut arguments;
        let results;
        if wanted.resume {
            let folder = self.root().folder(&wanted.path)?;
            if !changes.is_empty() || wanted.output.is_some() || wanted.fresh {
                let why = "a run goes on as it was started: leave out set, output and fresh";
                return Err(Refusal::value("resume", why));
            }
            arguments = vec!["resume".to_owned(), folder.argument()];
            results = folder;
        } else {
            let case = self.root().file(&wanted.path)?;
            results = match &wanted.output {
                Some(folder) => self.root().place(folder)?,
                // a link of this name leads elsewhere as any other
                None => self.root().place(&case.results().shown())?,
            };
            arguments = vec!["run".to_owned(), case.argument()];
            arguments.push(format!("--output={}", results.argument()));
            if wanted.fresh {
                arguments.push("--fresh".to_owned());
            }
            arguments.extend(changes);
        }
        arguments.push("--json".to_owned());
        arguments.push(format!("--max-wall={}s", wall.as_secs_f64()));
        if let Some(threads) = wanted.threads {
            let cores = std::thread::available_parallelism().map_or(1, usize::from);
            if !(1..=cores).contains(&usize::from(threads)) {
                let why = format!("this machine has {cores} cores: choose 1 to {cores}");
                return Err(Refusal::value("threads", why));
            }
            arguments.push(format!("--threads={threads}"));
        }
        Ok((arguments, results))
    }

    fn wall(&self, wanted: Option<f64>) -> Result<Duration, Refusal> {
        let most = self.limits().wall;
        let Some(seconds) = wanted else {
            return Ok(self.limits().default_wall.min(most));
        };
        match Duration::try_from_secs_f64(seconds) {
            Ok(time) if !time.is_zero() && time <= most => Ok(time),
            _ => {
                let why = format!("choose more than 0 and at most {} seconds", most.as_secs());
                Err(Refusal::value("max_wall", why))
            }
        }
    }

    /// How a run ended, for the client.
    fn outcome(&self, account: &Account, ended: &Ended, results: &Place) -> Result<Reply, Refusal> {
        // killed because it heeded no request to stop
        let code = ended.code.or(ended.stopped.map(|_| 130));
        let (Some(code), true) = (code, account.end.is_some() || ended.stopped.is_some()) else {
            // a panic, a crash, no memory: what was heard of it helps all the same
            let mut fault = ended.fault("run");
            if let (Refusal::Command { why, help, .. }, Some(_)) = (&mut fault, &account.start) {
                why.push_str(&format!(
                    "\n{}\nwhat had converged is in {}",
                    account.work(),
                    results.shown()
                ));
                *help =
                    "ask for its status, then go on with run, path = that folder, resume = true";
            }
            return Err(fault);
        };
        // one that cannot be read spoils no answer
        let summary = account.start.as_ref();
        let summary = summary.and_then(|_| self.summary(results).ok().flatten());
        let outcome = Outcome {
            account,
            code,
            stopped: ended.stopped.map(|stopped| match stopped {
                Stopped::Cancelled => "the request was cancelled",
                Stopped::OutOfTime => "the time was over",
                Stopped::TooLong => "it printed too much",
            }),
            results: account.start.as_ref().map(|_| results.shown()),
            summary,
        };
        Ok(Reply::new(outcome.text(), outcome.value()))
    }
}

/// How a run ended.
struct Outcome<'a> {
    account: &'a Account,
    code: i32,
    /// Why the server stopped it.
    stopped: Option<&'static str>,
    /// The folder of its results, where it started.
    results: Option<String>,
    summary: Option<Value>,
}

impl Outcome<'_> {
    fn status(&self) -> &str {
        self.account.status().unwrap_or("interrupted")
    }

    /// Whether `resume` can go on with it.
    fn is_resumable(&self) -> bool {
        self.results.is_some() && matches!(self.code, 5 | 6 | 8 | 130 | 143)
    }

    fn text(&self) -> String {
        let account = self.account;
        let mut text = format!(
            "{} (exit code {}): {}",
            self.status(),
            self.code,
            account.work()
        );
        if let Some(stopped) = self.stopped {
            text.push_str(&format!("; stopped because {stopped}"));
        }
        text.push('\n');
        let found = &account.diagnostics;
        text.push_str(&diagnostics_text(found, found.len()));
        if account.more > 0 {
            text.push_str(&format!("and {} more\n", account.more));
        }
        text.push_str(&expectations_text(&account.expectations));
        if let Some(last) = &account.increment {
            text.push_str(&contacts_text(&last["contact"]));
        }
        if let Some(results) = &self.results {
            text.push_str(&format!("results: {results}\n"));
        }
        if self.is_resumable() {
            text.push_str("go on with run, path = this folder, resume = true\n");
        }
        text.trim_end().to_owned()
    }

    fn value(&self) -> Value {
        let account = self.account;
        json!({
            "ok": self.code == 0,
            "exit_code": self.code,
            "status": self.status(),
            "stopped": self.stopped,
            "resumable": self.is_resumable(),
            "output": self.results,
            "increments": account.increments,
            "iterations": account.iterations,
            "cutbacks": account.cutbacks,
            "last_increment": account.increment,
            "diagnostics": account.diagnostics,
            "diagnostics_left_out": account.more,
            "expectations": account.expectations,
            "summary": self.summary,
        })
    }
}

/// Passes reports of progress on to a client that asked for them.
async fn pass_on(
    mut reports: Receiver<String>,
    peer: Peer<RoleServer>,
    token: Option<ProgressToken>,
) {
    let mut count = 0.0;
    while let Some(message) = reports.recv().await {
        let Some(token) = &token else { continue };
        count += 1.0;
        let report = ProgressNotificationParam::new(token.clone(), count);
        // a client that is gone ends the session elsewhere
        let _ = peer.notify_progress(report.with_message(message)).await;
    }
}
