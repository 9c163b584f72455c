//! Compiles and links the calls into MPI where the feature `mpi` asks for them.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "mpi")]
    mpi();
}

/// The calls into MPI, by the compiler of the MPI of the machine: `MPICC`, or `mpicc`.
#[cfg(feature = "mpi")]
fn mpi() {
    const SHIM: &str = "src/mpi/shim.c";
    println!("cargo::rerun-if-changed={SHIM}");
    println!("cargo::rerun-if-env-changed=MPICC");
    let compiler = std::env::var("MPICC").unwrap_or_else(|_| "mpicc".to_owned());
    let compiled = cc::Build::new()
        .compiler(&compiler)
        .file(SHIM)
        .try_compile("signorini_ranks");
    if let Err(error) = compiled {
        println!(
            "cargo::error=the feature `mpi` needs an MPI with its compiler `{compiler}` (Debian: apt install \
             libopenmpi-dev openmpi-bin; or set MPICC): {error}"
        );
        return;
    }
    // what the compiler would hand to the linker
    let shown = std::process::Command::new(&compiler).arg("-show").output();
    let words = shown.map_or_else(
        |_| String::new(),
        |shown| String::from_utf8_lossy(&shown.stdout).into_owned(),
    );
    for word in words.split_whitespace() {
        if let Some(folder) = word.strip_prefix("-L") {
            println!("cargo::rustc-link-search=native={folder}");
        } else if let Some(library) = word.strip_prefix("-l") {
            println!("cargo::rustc-link-lib=dylib={library}");
        }
    }
}
