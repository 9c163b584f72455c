//! Compiles and links what the optional features need of C.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "mumps")]
    mumps();
    #[cfg(feature = "mpi")]
    petsc();
    #[cfg(all(feature = "mumps", feature = "mpi"))]
    println!(
        "cargo::error=the features `mumps` and `mpi` exclude one another: MUMPS for one process has calls of the names of \
         MPI; with `mpi`, leave `mumps` out"
    );
}

/// The calls into MUMPS, against the headers of the machine.
#[cfg(feature = "mumps")]
fn mumps() {
    const SHIM: &str = "src/mumps/shim.c";
    println!("cargo::rerun-if-changed={SHIM}");
    let compiled = cc::Build::new().file(SHIM).try_compile("signorini_mumps");
    match compiled {
        Ok(()) => println!("cargo::rustc-link-lib=dylib=dmumps_seq"),
        Err(error) => println!(
            "cargo::error=the feature `mumps` needs MUMPS for one process and doubles, with dmumps_c.h and \
             libdmumps_seq where the C compiler finds them (Debian: apt install libmumps-seq-dev): {error}"
        ),
    }
}

/// The calls into PETSc, as its file for pkg-config says: that of `PETSC_DIR` and `PETSC_ARCH`, or of the machine.
#[cfg(feature = "mpi")]
fn petsc() {
    const SHIM: &str = "src/multigrid/petsc/shim.c";
    println!("cargo::rerun-if-changed={SHIM}");
    for name in ["MPICC", "PETSC_DIR", "PETSC_ARCH", "PKG_CONFIG_PATH"] {
        println!("cargo::rerun-if-env-changed={name}");
    }
    let compiler = std::env::var("MPICC").unwrap_or_else(|_| "mpicc".to_owned());
    let words = pkg_config();
    let mut build = cc::Build::new();
    build.compiler(&compiler).file(SHIM);
    for word in &words {
        if let Some(folder) = word.strip_prefix("-I") {
            build.include(folder);
        }
    }
    if let Err(error) = build.try_compile("signorini_petsc") {
        println!(
            "cargo::error=the feature `mpi` needs PETSc 3.18 or later, of real numbers in double precision with indices of \
             32 bits, where pkg-config or PETSC_DIR finds it (Debian: apt install libpetsc-real-dev libopenmpi-dev \
             openmpi-bin pkg-config): {error}"
        );
        return;
    }
    for word in &words {
        if let Some(folder) = word.strip_prefix("-L") {
            println!("cargo::rustc-link-search=native={folder}");
        } else if let Some(library) = word.strip_prefix("-l") {
            println!("cargo::rustc-link-lib=dylib={library}");
        }
    }
}

/// What a compiler and a linker need for PETSc; nothing where it is not found.
#[cfg(feature = "mpi")]
fn pkg_config() -> Vec<String> {
    let variable = |name: &str| std::env::var(name).unwrap_or_default();
    let (folder, arch) = (variable("PETSC_DIR"), variable("PETSC_ARCH"));
    let own = |part: &str| format!("{folder}/{part}lib/pkgconfig");
    let mut paths = vec![variable("PKG_CONFIG_PATH")];
    if !folder.is_empty() {
        paths.extend([own(&format!("{arch}/")), own("")]);
    }
    // where Debian keeps that of real numbers
    paths.push("/usr/lib/petscdir/petsc-real/lib/pkgconfig".to_owned());
    let paths: Vec<String> = paths.into_iter().filter(|path| !path.is_empty()).collect();
    let found = std::process::Command::new("pkg-config")
        .args(["--cflags", "--libs", "PETSc"])
        .env("PKG_CONFIG_PATH", paths.join(":"))
        .output();
    found.map_or_else(
        |_| Vec::new(),
        |found| {
            let words = String::from_utf8_lossy(&found.stdout).into_owned();
            words.split_whitespace().map(str::to_owned).collect()
        },
    )
}
