//! Compiles and links what the optional features need of C.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    #[cfg(feature = "mumps")]
    mumps();
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
