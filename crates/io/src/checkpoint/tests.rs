use std::io::ErrorKind;

use super::*;
use crate::fs::{FailingFs, RealFs, TornFs};

const CASE: [u8; 32] = [42; 32];

fn archive(seed: u64) -> Archive {
    let mut archive = Archive::new();
    archive
        .put_f64(
            "state/displacement",
            &[
                0.1 * seed as f64,
                -0.0,
                f64::MIN_POSITIVE,
                f64::from_bits(seed),
            ],
        )
        .unwrap();
    archive.put_f64("empty", &[]).unwrap();
    archive.put_u64("history_rows", &[seed, u64::MAX]).unwrap();
    archive
        .put_u8("contact/ü/status", &[0, 1, 2, 255, seed as u8])
        .unwrap();
    archive
}

fn stamp(increment: u64) -> Stamp {
    Stamp {
        step: 1,
        increment,
        time: 0.1 * increment as f64,
    }
}

/// Two checkpoints, of increments 1 in `a.sgc` and 2 in `b.sgc`.
fn two() -> (tempfile::TempDir, Checkpoints) {
    let dir = tempfile::tempdir().unwrap();
    let mut checkpoints = Checkpoints::new(dir.path(), CASE);
    for i in 1..=2 {
        checkpoints.write(&RealFs, stamp(i), &archive(i)).unwrap();
    }
    (dir, checkpoints)
}

/// A checkpoint is what was written at its increment, to the bit.
fn assert_true(found: &Checkpoint) {
    let expected = archive(found.stamp.increment);
    assert_eq!(
        (found.stamp, &found.archive),
        (stamp(found.stamp.increment), &expected)
    );
    let bits = |a: &Archive| {
        a.get_f64("state/displacement")
            .unwrap()
            .iter()
            .map(|v| v.to_bits())
            .collect::<Vec<_>>()
    };
    assert_eq!(bits(&found.archive), bits(&expected));
}

#[test]
fn files_take_turns_and_the_newest_is_found() {
    let dir = tempfile::tempdir().unwrap();
    let mut checkpoints = Checkpoints::new(dir.path(), CASE);
    assert!(matches!(
        checkpoints.latest_good(&RealFs),
        Err(CheckpointError::Missing { .. })
    ));
    for i in 1..=5 {
        let path = checkpoints.write(&RealFs, stamp(i), &archive(i)).unwrap();
        assert!(path.ends_with(if i % 2 == 1 { "a.sgc" } else { "b.sgc" }));
        let found = checkpoints.latest_good(&RealFs).unwrap();
        assert_true(&found);
        assert_eq!(
            (
                found.stamp.increment,
                found.sequence,
                &found.path,
                &found.passed_over
            ),
            (i, i, &path, &None)
        );
        // A resumed run goes on with the turns.
        if i == 3 {
            checkpoints = Checkpoints::new(dir.path(), CASE);
        }
    }
    checkpoints.clear(&RealFs).unwrap();
    checkpoints.clear(&RealFs).unwrap();
    assert!(RealFs.list(dir.path()).unwrap().is_empty());
}

#[test]
fn as_many_files_take_turns_as_are_kept() {
    let dir = tempfile::tempdir().unwrap();
    let mut checkpoints = Checkpoints::new(dir.path(), CASE).keeping(3);
    for i in 1..=4 {
        checkpoints.write(&RealFs, stamp(i), &archive(i)).unwrap();
    }
    assert_eq!(RealFs.list(dir.path()).unwrap().len(), 3);
    for (good, damaged) in [(4, "a.sgc"), (3, "c.sgc"), (2, "b.sgc")] {
        let found = checkpoints.latest_good(&RealFs).unwrap();
        assert_true(&found);
        assert_eq!(found.stamp.increment, good);
        std::fs::write(dir.path().join(damaged), "torn").unwrap();
    }
    assert!(checkpoints.latest_good(&RealFs).is_err());

    // fewer from now on: the files in turns are the first ones, and the newest one counts wherever it is
    let mut fewer = Checkpoints::new(dir.path(), CASE);
    for (i, name) in [(5, "a.sgc"), (6, "b.sgc"), (7, "a.sgc")] {
        let path = fewer.write(&RealFs, stamp(i), &archive(i)).unwrap();
        assert!(path.ends_with(name), "{}", path.display());
        assert_eq!(fewer.latest_good(&RealFs).unwrap().stamp.increment, i);
    }
}

#[test]
fn a_large_array_comes_back_to_the_bit() {
    let dir = tempfile::tempdir().unwrap();
    let values: Vec<f64> = (0..1_000_003_u64)
        .map(|i| f64::from_bits(i.wrapping_mul(0x9e3779b97f4a7c15)))
        .collect();
    let mut archive = Archive::new();
    archive.put_f64("u", &values).unwrap();
    let mut checkpoints = Checkpoints::new(dir.path(), CASE);
    checkpoints.write(&RealFs, stamp(1), &archive).unwrap();
    let found = checkpoints.latest_good(&RealFs).unwrap();
    let back = found.archive.get_f64("u").unwrap();
    assert!(
        back.len() == values.len()
            && back
                .iter()
                .zip(&values)
                .all(|(a, b)| a.to_bits() == b.to_bits())
    );
}

#[test]
fn a_flipped_bit_anywhere_is_noticed() {
    let (dir, checkpoints) = two();
    let path = dir.path().join("b.sgc");
    let good = RealFs.read(&path).unwrap();
    for at in 0..good.len() {
        for bit in 0..8 {
            let mut bad = good.clone();
            bad[at] ^= 1 << bit;
            std::fs::write(&path, &bad).unwrap();
            let found = checkpoints.latest_good(&RealFs).unwrap();
            assert_true(&found);
            assert_eq!(found.stamp.increment, 1, "the other file is taken");
            assert!(found.passed_over.unwrap().contains("b.sgc is damaged"));
        }
    }
}

#[test]
fn any_byte_changed_in_both_files_is_an_error() {
    let (dir, checkpoints) = two();
    let paths = [0, 1].map(|slot| dir.path().join(file(slot)));
    let good = paths.each_ref().map(|path| RealFs.read(path).unwrap());
    for at in 0..good[0].len() {
        for (path, good) in paths.iter().zip(&good) {
            let mut bad = good.clone();
            bad[at] = !bad[at];
            std::fs::write(path, &bad).unwrap();
        }
        assert!(
            matches!(
                checkpoints.latest_good(&RealFs),
                Err(CheckpointError::Corrupt { .. })
            ),
            "byte {at}"
        );
    }
}

#[test]
fn a_file_of_any_other_length_is_refused() {
    let (dir, checkpoints) = two();
    let path = dir.path().join("b.sgc");
    let good = RealFs.read(&path).unwrap();
    for length in 0..good.len() {
        std::fs::write(&path, &good[..length]).unwrap();
        assert_eq!(
            checkpoints.latest_good(&RealFs).unwrap().stamp.increment,
            1,
            "{length}"
        );
    }
    std::fs::write(&path, [&good[..], &[0]].concat()).unwrap();
    assert_eq!(checkpoints.latest_good(&RealFs).unwrap().stamp.increment, 1);
    RealFs.remove(&path).unwrap();
    assert_eq!(checkpoints.latest_good(&RealFs).unwrap().stamp.increment, 1);
}

#[test]
fn another_case_and_another_format_are_said() {
    let (dir, _) = two();
    let other = Checkpoints::new(dir.path(), [43; 32]);
    assert!(matches!(
        other.latest_good(&RealFs),
        Err(CheckpointError::OtherCase { .. })
    ));
    for version in [0, FORMAT_VERSION - 1, FORMAT_VERSION + 1, u32::MAX] {
        for slot in [0, 1] {
            let path = dir.path().join(file(slot));
            let mut bytes = RealFs.read(&path).unwrap();
            bytes[8..12].copy_from_slice(&version.to_le_bytes());
            let crc = crc32(&bytes[..12]);
            bytes[12..16].copy_from_slice(&crc.to_le_bytes());
            std::fs::write(&path, &bytes).unwrap();
        }
        let error = Checkpoints::new(dir.path(), CASE)
            .latest_good(&RealFs)
            .unwrap_err();
        assert!(
            matches!(error, CheckpointError::OtherFormat { found, .. } if found == version),
            "{error}"
        );
    }
    assert_eq!(CheckpointError::EXIT_CODE, 7);
}

#[test]
fn a_damaged_file_is_the_next_to_be_overwritten() {
    let (dir, _) = two();
    std::fs::write(dir.path().join("b.sgc"), b"torn").unwrap();
    let mut checkpoints = Checkpoints::new(dir.path(), CASE);
    let path = checkpoints.write(&RealFs, stamp(3), &archive(3)).unwrap();
    assert!(path.ends_with("b.sgc"));
    let found = checkpoints.latest_good(&RealFs).unwrap();
    assert_eq!(
        (found.stamp.increment, found.sequence, found.passed_over),
        (3, 2, None)
    );
}

#[test]
fn whichever_operation_fails_the_last_good_checkpoint_is_read() {
    for n in 1..=9 {
        for forever in [false, true] {
            let (dir, _) = two();
            let fs = match forever {
                true => FailingFs::from_nth(RealFs, n, ErrorKind::StorageFull),
                false => FailingFs::nth(RealFs, n, ErrorKind::StorageFull),
            };
            let mut checkpoints = Checkpoints::new(dir.path(), CASE);
            let mut last = 2;
            for i in 3..=5 {
                match checkpoints.write(&fs, stamp(i), &archive(i)) {
                    Ok(_) => last = i,
                    Err(error) => assert!(error.to_string().contains("disk full while writing")),
                }
                let found = Checkpoints::new(dir.path(), CASE)
                    .latest_good(&RealFs)
                    .unwrap();
                assert_true(&found);
                // Where only the synchronization failed, one that was reported as failed is there already.
                let newer = (last + 1..=i).contains(&found.stamp.increment) && n % 3 == 0;
                assert!(found.stamp.increment == last || newer);
            }
        }
    }
}

#[test]
fn a_power_cut_at_every_length_leaves_the_last_good_checkpoint() {
    let length = encode(3, &CASE, stamp(3), &archive(3)).len();
    for keep in 0..=length {
        let (dir, mut checkpoints) = two();
        checkpoints
            .write(&TornFs::nth(RealFs, 1, keep), stamp(3), &archive(3))
            .unwrap_err();
        let found = checkpoints.latest_good(&RealFs).unwrap();
        assert_true(&found);
        assert_eq!(found.stamp.increment, 2);
        // The disk lies: the torn file has its final name.
        let (lied, mut checkpoints) = two();
        checkpoints
            .write(&TornFs::lying(RealFs, 1, keep, 1), stamp(3), &archive(3))
            .unwrap_err();
        let found = checkpoints.latest_good(&RealFs).unwrap();
        assert_true(&found);
        assert_eq!(found.stamp.increment, if keep == length { 3 } else { 2 });
        drop((dir, lied));
    }
}

#[test]
fn bytes_with_right_checksums_and_wrong_counts_are_refused_without_asking_for_memory() {
    let good = encode(1, &CASE, stamp(1), &archive(1));
    let read = |change: &dyn Fn(&mut Vec<u8>)| {
        let mut bytes = good.clone();
        bytes.truncate(good.len() - 4);
        change(&mut bytes);
        let length = bytes.len() as u64 + 4;
        bytes[16..24].copy_from_slice(&length.to_le_bytes());
        let crc = crc32(&bytes);
        bytes.extend_from_slice(&crc.to_le_bytes());
        decode(&bytes, &CASE, PathBuf::from("x"))
    };
    assert_true(&read(&|_| {}).unwrap());
    for count in [0, 3, 5, u64::MAX] {
        assert!(read(&|b| b[88..96].copy_from_slice(&count.to_le_bytes())).is_err());
    }
    for count in [0, 4, 6, 1 << 40, u64::MAX / 8, u64::MAX] {
        assert!(
            read(&|b| b[99..107].copy_from_slice(&count.to_le_bytes())).is_err(),
            "{count}"
        );
    }
    for kind in [0, 1, 4, 255] {
        assert!(read(&|b| b[96] = kind).is_err());
    }
    assert!(read(&|b| b.push(0)).is_err());
    // Whatever the bytes behind the head are, nothing panics.
    for at in HEAD..good.len() - 4 {
        for value in [0, 1, 127, 255] {
            let _ = read(&|b| b[at] = value);
        }
    }
}

#[test]
fn arrays_are_asked_for_by_name_type_and_length() {
    let mut archive = archive(1);
    assert!(matches!(
        archive.get_f64("none"),
        Err(ArchiveError::Missing { .. })
    ));
    assert!(matches!(
        archive.get_u64("empty"),
        Err(ArchiveError::WrongType {
            expected: "u64",
            found: "f64",
            ..
        })
    ));
    let mut out = [7; 2];
    assert!(matches!(
        archive.copy_u8("contact/ü/status", &mut out),
        Err(ArchiveError::WrongLength {
            expected: 2,
            found: 5,
            ..
        })
    ));
    assert_eq!(out, [7; 2]);
    let mut out = [0; 2];
    archive.copy_u64("history_rows", &mut out).unwrap();
    assert_eq!(out, [1, u64::MAX]);
    assert!(matches!(
        archive.put_u8("empty", &[1]),
        Err(ArchiveError::BadName { .. })
    ));
    assert!(matches!(
        archive.put_u8(&"x".repeat(70_000), &[1]),
        Err(ArchiveError::BadName { .. })
    ));
    assert_eq!(
        archive.names().collect::<Vec<_>>(),
        [
            "contact/ü/status",
            "empty",
            "history_rows",
            "state/displacement"
        ]
    );
    assert_eq!(archive.narray(), 4);
}
