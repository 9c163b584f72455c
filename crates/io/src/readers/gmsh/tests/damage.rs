//! Damaged and malicious files end in an error or a mesh, and cost little memory.

use super::*;
use crate::readers::validate;
use std::fmt::Write as _;

#[test]
fn a_hundred_bytes_cannot_ask_for_a_hundred_gigabytes() {
    for count in ["1000000000", "999999999999", "9223372036854775807"] {
        let files = [
            format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{count}\n1 0 0 0\n"),
            format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{count}\n"),
            format!(
                "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n{count} {count} 1 {count}\n0 1 0 {count}\n"
            ),
            format!("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 1\n0 1 0 {count}\n1\n"),
            format!(
                "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n{count} {count} 0 0\n1 0 0 0 {count} 1\n"
            ),
        ];
        for file in files {
            let error = read("bomb.msh", file.as_bytes()).unwrap_err();
            let refused = matches!(
                error,
                MeshError::TooMany { .. } | MeshError::Count { .. } | MeshError::Truncated { .. }
            );
            assert!(refused, "{error}");
        }
    }
}

#[test]
fn groups_cannot_multiply_without_bound() {
    let (ngroup, ncell) = (2000, 2000);
    let mut text =
        String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 0 1\n1 0 0 0 1 1 1 ");
    write!(text, "{ngroup}").unwrap();
    (1..=ngroup).for_each(|g| write!(text, " {g}").unwrap());
    text += " 0\n$EndEntities\n$Nodes\n1 4 1 4\n3 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n$EndNodes\n$Elements\n";
    writeln!(text, "1 {ncell} 1 {ncell}\n3 1 4 {ncell}").unwrap();
    (1..=ncell).for_each(|e| writeln!(text, "{e} 1 2 3 4").unwrap());
    text += "$EndElements\n";
    let error = read("box.msh", text.as_bytes()).unwrap_err();
    assert!(
        matches!(
            error,
            MeshError::TooManyMemberships {
                found: 4_000_000,
                ..
            }
        ),
        "{error}"
    );
}

/// The numbers of the generator `x ← 6364136223846793005 x + 1442695040888963407`.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % n.max(1)
    }
}

fn mutate_bytes(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len());
        match random.below(5) {
            0 => bytes[at] = random.below(256) as u8,
            1 => bytes[at] ^= 1 << random.below(8),
            2 => bytes.truncate(at.max(1)),
            3 => drop(bytes.drain(at..(at + random.below(20)).min(bytes.len()))),
            _ => {
                let piece = bytes[at..(at + random.below(40)).min(bytes.len())].to_vec();
                let to = random.below(bytes.len());
                bytes.splice(to..to, piece);
            }
        }
        if bytes.is_empty() {
            bytes.push(b'$');
        }
    }
}

fn mutate_words(text: &str, random: &mut Random) -> String {
    const ODD: [&str; 16] = [
        "0",
        "-1",
        "1",
        "2",
        "15",
        "4294967295",
        "9223372036854775807",
        "18446744073709551616",
        "1e308",
        "nan",
        "-inf",
        "$Nodes",
        "$EndNodes",
        "\"",
        "é",
        "",
    ];
    let mut words: Vec<&str> = text.split_inclusive([' ', '\n']).collect();
    let replaced: Vec<String> = ODD.iter().map(|w| format!("{w} ")).collect();
    for _ in 0..=random.below(3) {
        let (at, other) = (random.below(words.len()), random.below(words.len()));
        match random.below(4) {
            0 => words.swap(at, other),
            1 => drop(words.remove(at)),
            2 => words.insert(at, words[other]),
            _ => words[at] = &replaced[random.below(ODD.len())],
        }
    }
    words.concat()
}

/// Bytes that reading a damaged file of up to 14 kB may allocate, all together.
const MOST: u64 = 1 << 22;

#[test]
fn two_thousand_damaged_files_end_in_a_mesh_or_an_error_and_take_little_memory() {
    let texts = [
        V2,
        V4,
        include_str!("../../../../tests/data/box_22_text.msh"),
        include_str!("../../../../tests/data/box_41_partitioned.msh"),
        include_str!("../../../../tests/data/brick_41_text.msh"),
    ];
    let mut binaries: Vec<Vec<u8>> = vec![
        include_bytes!("../../../../tests/data/box_22_parametric_binary.msh").to_vec(),
        include_bytes!("../../../../tests/data/box_41_parametric_binary.msh").to_vec(),
        to_binary(V2, true, true),
        to_binary(V4, true, true),
        to_binary(V4, false, false),
    ];
    binaries.extend(texts.map(|t| t.as_bytes().to_vec()));
    let mut random = Random(20_240_229);
    let (mut read_anyway, mut refused) = (0, 0);
    for round in 0..2000 {
        let bytes = if round % 2 == 0 {
            let mut bytes = binaries[random.below(binaries.len())].clone();
            mutate_bytes(&mut bytes, &mut random);
            bytes
        } else {
            mutate_words(texts[random.below(texts.len())], &mut random).into_bytes()
        };
        let mut result = None;
        let taken = allocation_counter::measure(|| result = Some(read("damaged.msh", &bytes)));
        assert!(taken.bytes_total < MOST, "round {round}: {taken:?}");
        match result.unwrap() {
            Ok((mesh, _)) => {
                let _ = validate(&mesh);
                read_anyway += 1;
            }
            Err(error) => {
                let message = error.to_string();
                assert!(
                    message.starts_with("damaged.msh") && message.len() < 600,
                    "{message}"
                );
                refused += 1;
            }
        }
    }
    assert!(
        read_anyway > 100 && refused > 1000,
        "{read_anyway} {refused}"
    );
}

#[test]
fn every_beginning_of_a_file_is_refused() {
    for whole in [
        V2.as_bytes().to_vec(),
        V4.as_bytes().to_vec(),
        to_binary(V2, false, true),
        to_binary(V4, true, true),
    ] {
        for end in 0..whole.len() - 1 {
            assert!(read("cut.msh", &whole[..end]).is_err(), "{end}");
        }
    }
}
