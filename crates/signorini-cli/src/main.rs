//! The `signorini` command.

#[global_allocator]
static MEMORY: signorini_cli::LargePages = signorini_cli::LargePages;

fn main() -> std::process::ExitCode {
    signorini_cli::main(std::env::args_os()).into()
}
