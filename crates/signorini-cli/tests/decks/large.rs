//! A deck of a million elements.

use std::fs::File;
use std::io::{BufWriter, Result, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

/// Elements along an edge of the cube.
const N: usize = 100;

/// Bytes of memory.
const MEMORY: u64 = 1 << 30;

/// Numbers, sixteen in a line.
fn list(out: &mut impl Write, numbers: impl IntoIterator<Item = usize>) -> Result<()> {
    let mut in_line = 0;
    for number in numbers {
        in_line = (in_line + 1) % 16;
        write!(out, "{number}{}", if in_line == 0 { ",\n" } else { ", " })?;
    }
    writeln!(out)
}

/// A cube of hexahedra that is held below and pulled above, with sets and a surface.
fn write(path: &Path) -> Result<()> {
    let out = &mut BufWriter::with_capacity(1 << 20, File::create(path)?);
    let number = |i: usize, j: usize, k: usize| 1 + i + (N + 1) * (j + (N + 1) * k);
    writeln!(out, "*NODE, NSET=Nall")?;
    for k in 0..=N {
        for j in 0..=N {
            for i in 0..=N {
                let x = [i, j, k].map(|i| i as f64 / 7.0);
                let n = number(i, j, k);
                writeln!(out, "{n}, {:.9}, {:.9}, {:.9}", x[0], x[1], x[2])?;
            }
        }
    }
    writeln!(out, "*ELEMENT, TYPE=C3D8, ELSET=Eall")?;
    for k in 0..N {
        for j in 0..N {
            for i in 0..N {
                let below = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
                write!(out, "{}", 1 + i + N * (j + N * k))?;
                for (i, j, k) in [k, k + 1]
                    .iter()
                    .flat_map(|k| below.map(|(i, j)| (i, j, *k)))
                {
                    write!(out, ", {}", number(i, j, k))?;
                }
                writeln!(out)?;
            }
        }
    }
    let layer = (N + 1) * (N + 1);
    writeln!(out, "*NSET, NSET=bottom")?;
    list(out, 1..=layer)?;
    writeln!(
        out,
        "*NSET, NSET=top, GENERATE\n{}, {}",
        number(0, 0, N),
        number(N, N, N)
    )?;
    writeln!(out, "*ELSET, ELSET=roof")?;
    list(out, N * N * (N - 1) + 1..=N * N * N)?;
    writeln!(out, "*SURFACE, NAME=above\nroof, S2")?;
    out.write_all(
        b"*MATERIAL, NAME=steel\n*ELASTIC\n210000., 0.3\n*SOLID SECTION, ELSET=Eall, MATERIAL=steel\n\
          *STEP\n*STATIC\n*BOUNDARY\nbottom, 1, 3\n*CLOAD\ntop, 3, 1.\n*NODE FILE\nU\n*END STEP\n",
    )?;
    out.flush()
}

/// The most memory that a process has held, in bytes.
fn peak(pid: u32) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().trim_end_matches(" kB").trim().parse().ok()?;
    Some(1024 * kilobytes)
}

/// `convert` reads a deck and its mesh and builds nothing.
#[test]
#[cfg_attr(debug_assertions, ignore = "takes long without optimisation")]
fn a_deck_of_a_million_elements_is_read_in_a_gigabyte() {
    let scratch = tempfile::tempdir().unwrap();
    let (deck, case) = (
        scratch.path().join("cube.inp"),
        scratch.path().join("case.toml"),
    );
    write(&deck).unwrap();
    let mut reading = Command::new(env!("CARGO_BIN_EXE_signorini"))
        .arg("convert")
        .args([&deck, &case])
        .stderr(Stdio::null())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    let mut memory = 0;
    let end = loop {
        memory = peak(reading.id()).map_or(memory, |now| memory.max(now));
        if let Some(end) = reading.try_wait().unwrap() {
            break end;
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let bytes = std::fs::metadata(&deck).unwrap().len();
    println!("{bytes} bytes with {memory} bytes of memory");
    assert!(end.success() && case.is_file());
    assert!(memory < MEMORY, "{memory}");
}
