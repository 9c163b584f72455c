use std::io::ErrorKind;

use serde_json::json;

use super::*;
use crate::fs::{FailingFs, RealFs, TornFs};
use crate::vtk::xml::assert_well_formed;
use crate::writers::pvd::{Pvd, PvdError};

/// A unit brick with a vertex on it and every kind of field.
struct Sample {
    points: Vec<[f64; 3]>,
    displacement: Vec<[f64; 3]>,
    pressure: Vec<f64>,
    status: Vec<i8>,
    stress: Vec<SymTensor>,
    body: Vec<i32>,
    element: Vec<i64>,
}

const TYPES: [u8; 2] = [12, 1];
const OFFSETS: [usize; 3] = [0, 8, 9];
const CONNECTIVITY: [u32; 9] = [0, 1, 2, 3, 4, 5, 6, 7, 8];

impl Sample {
    fn new() -> Self {
        let corner = |x, y, z| [f64::from(x), f64::from(y), f64::from(z)];
        let mut points: Vec<_> = [0, 1]
            .into_iter()
            .flat_map(|z| [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(x, y)| corner(x, y, z)))
            .collect();
        points.push([0.5, 0.25, 1.0 / 3.0]);
        let n = points.len();
        Self {
            displacement: (0..n)
                .map(|i| [0.1 * i as f64, -1e-300, f64::from_bits(i as u64)])
                .collect(),
            pressure: (0..n).map(|i| (i as f64).sqrt()).collect(),
            status: (0..n).map(|i| i as i8 - 1).collect(),
            stress: vec![
                SymTensor {
                    xx: 1.0,
                    yy: 2.0,
                    zz: 3.0,
                    xy: 4.0,
                    yz: 5.0,
                    xz: 6.0,
                },
                SymTensor::default(),
            ],
            body: vec![7, -7],
            element: vec![1 << 40, -1],
            points,
        }
    }

    fn with_grid<T>(&self, run: impl FnOnce(&Grid<'_>) -> T) -> T {
        let grid = Grid {
            points: &self.points,
            types: &TYPES,
            offsets: &OFFSETS,
            connectivity: &CONNECTIVITY,
            point_data: &[
                Field::new("contact_status", Values::Int8(&self.status)),
                Field::new("displacement", Values::Vector(&self.displacement)),
                Field::new("contact_pressure", Values::Scalar(&self.pressure)),
            ],
            cell_data: &[
                Field::new("stress", Values::Tensor(&self.stress)),
                Field::new("body", Values::Int32(&self.body)),
                Field::new("element <&\"id\">", Values::Int64(&self.element)),
            ],
            facts: &[
                Fact {
                    name: "TimeValue",
                    value: FactValue::Real(&[0.1 + 0.2]),
                },
                Fact {
                    name: "step",
                    value: FactValue::Whole(&[2]),
                },
                Fact {
                    name: "step_name",
                    value: FactValue::Text("drück <1>"),
                },
            ],
        };
        run(&grid)
    }

    fn encode(&self, options: &Options) -> Vec<u8> {
        self.with_grid(|grid| encode(grid, options)).unwrap()
    }
}

fn all_options() -> Vec<Options> {
    let mut all = Vec::new();
    for single in [false, true] {
        for compression in [None, Some(0), Some(1), Some(9)] {
            for long_ids in [false, true] {
                all.push(Options {
                    single,
                    compression,
                    long_ids,
                });
            }
        }
    }
    all
}

#[test]
fn every_value_is_read_back() {
    let sample = Sample::new();
    for options in all_options() {
        let vtu = read(&sample.encode(&options)).unwrap();
        let stored = |v: f64| {
            if options.single {
                f64::from(v as f32)
            } else {
                v
            }
        };
        let bits = |v: &[f64]| v.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        let same = |array: &Array, expected: &[f64]| {
            let expected: Vec<f64> = expected.iter().map(|v| stored(*v)).collect();
            assert_eq!(
                bits(&array.numbers.to_f64()),
                bits(&expected),
                "{} with {options:?}",
                array.name
            );
            assert_eq!(matches!(array.numbers, Numbers::F32(_)), options.single);
        };
        for (point, expected) in vtu.points.iter().zip(&sample.points) {
            assert_eq!(*point, expected.map(stored));
        }
        assert_eq!(vtu.points.len(), 9);
        assert_eq!(vtu.types, TYPES);
        assert_eq!(vtu.offsets, OFFSETS);
        assert_eq!(vtu.connectivity, CONNECTIVITY.map(|n| n as usize));
        same(
            vtu.point_field("displacement").unwrap(),
            sample.displacement.as_flattened(),
        );
        same(
            vtu.point_field("contact_pressure").unwrap(),
            &sample.pressure,
        );
        assert_eq!(
            vtu.point_field("contact_status").unwrap().numbers,
            Numbers::I8(sample.status.clone())
        );
        let stress = vtu.cell_field("stress").unwrap();
        same(
            stress,
            &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        );
        assert_eq!(
            (stress.ncomponent, stress.component_names.join(" ")),
            (6, "XX YY ZZ XY YZ XZ".to_string())
        );
        assert_eq!(
            vtu.cell_field("body").unwrap().numbers,
            Numbers::I32(sample.body.clone())
        );
        assert_eq!(
            vtu.cell_field("element <&\"id\">").unwrap().numbers,
            Numbers::I64(sample.element.clone())
        );
        assert_eq!(
            vtu.time(),
            Some(0.1 + 0.2),
            "the time keeps its bits in single precision too"
        );
        assert_eq!(vtu.fact("step").unwrap().numbers, Numbers::I64(vec![2]));
        assert_eq!(
            vtu.fact("step_name").unwrap().numbers,
            Numbers::Text("drück <1>".into())
        );
    }
}

#[test]
fn the_xml_is_well_formed_and_names_what_viewers_need() {
    let bytes = Sample::new().encode(&Options::default());
    let raw = bytes.windows(4).position(|w| w == b"   _").unwrap();
    let xml = std::str::from_utf8(&bytes[..raw]).unwrap();
    assert_well_formed(&format!("{xml}</AppendedData></VTKFile>"));
    assert!(bytes.ends_with(b"\n  </AppendedData>\n</VTKFile>\n"));
    for needle in [
        "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"",
        "<PointData Vectors=\"displacement\">",
        "Name=\"connectivity\" format=\"appended\"",
        "NumberOfComponents=\"6\" ComponentName0=\"XX\" ComponentName1=\"YY\" ComponentName2=\"ZZ\" ComponentName3=\"XY\" ComponentName4=\"YZ\" ComponentName5=\"XZ\"",
        "type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\"",
    ] {
        assert!(xml.contains(needle), "{needle} is not in\n{xml}");
    }
}

#[test]
fn arrays_of_many_pieces_are_read_back_and_do_not_depend_on_threads() {
    // Sizes around the size of a piece, in numbers of 8 bytes, and a large one.
    for n in [
        0,
        1,
        PIECE / 8 - 1,
        PIECE / 8,
        PIECE / 8 + 1,
        3 * PIECE / 8,
        1_000_003,
    ] {
        let points = vec![[0.0; 3]; n];
        let wave: Vec<f64> = (0..n).map(|i| (i as f64 * 1e-3).sin()).collect();
        let data = [Field::new("wave", Values::Scalar(&wave))];
        let grid = Grid {
            points: &points,
            point_data: &data,
            ..Grid::default()
        };
        let bytes = encode(&grid, &Options::default()).unwrap();
        let one = rayon::ThreadPoolBuilder::new()
            .num_threads(1)
            .build()
            .unwrap();
        assert!(one.install(|| encode(&grid, &Options::default())).unwrap() == bytes);
        let vtu = read(&bytes).unwrap();
        assert!(
            vtu.point_field("wave").unwrap().numbers == Numbers::F64(wave),
            "{n}"
        );
        assert_eq!(
            (vtu.points.len(), vtu.types.len(), vtu.offsets),
            (n, 0, vec![0])
        );
    }
}

#[test]
fn what_compression_does_not_make_smaller_is_stored_as_it_is() {
    let n = 3 * PIECE / 8 + 5;
    let mut state = 1u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        f64::from_bits(0x3ff0_0000_0000_0000 | state >> 12)
    };
    let noise: Vec<f64> = (0..n).map(|_| noise()).collect();
    // noise here and there is no reason to store the rest
    let steps: Vec<f64> = (0..n)
        .map(|i| if i % 64 == 0 { noise[i] } else { 2.0 })
        .collect();
    let points = vec![[0.0; 3]; n];
    let size = |values: &[f64]| {
        let data = [Field::new("values", Values::Scalar(values))];
        let grid = Grid {
            points: &points,
            point_data: &data,
            ..Grid::default()
        };
        let bytes = encode(&grid, &Options::default()).unwrap();
        let vtu = read(&bytes).unwrap();
        let found = &vtu.point_field("values").unwrap().numbers;
        assert!(*found == Numbers::F64(values.to_vec()));
        bytes.len()
    };
    let nothing = size(&vec![0.0; n]);
    let (noise, steps) = (size(&noise) - nothing, size(&steps) - nothing);
    assert!(noise.abs_diff(8 * n) < 8 * n / 100, "{noise} of {}", 8 * n);
    assert!(steps < 8 * n / 10, "{steps} of {}", 8 * n);
}

#[test]
fn every_cell_type_is_written_with_its_number_of_nodes() {
    let (types, offsets, connectivity) = one_cell_of_every_type();
    assert_eq!(
        types,
        [
            1, 3, 5, 8, 9, 10, 11, 12, 13, 21, 22, 23, 24, 25, 26, 28, 29
        ]
    );
    let points: Vec<[f64; 3]> = (0..27).map(|i| [f64::from(i), 0.0, 0.0]).collect();
    let grid = Grid {
        points: &points,
        types: &types,
        offsets: &offsets,
        connectivity: &connectivity,
        ..Grid::default()
    };
    let vtu = read(&encode(&grid, &Options::default()).unwrap()).unwrap();
    assert_eq!((vtu.types, vtu.offsets), (types, offsets));
}

/// Types, offsets and connectivity.
fn one_cell_of_every_type() -> (Vec<u8>, Vec<usize>, Vec<u32>) {
    let (mut types, mut offsets, mut connectivity) = (vec![cells::VERTEX], vec![0, 1], vec![0]);
    for one in CellType::by_number().into_iter().flatten() {
        types.push(one.number);
        connectivity.extend(0..one.element.nnode() as u32);
        offsets.push(connectivity.len());
    }
    (types, offsets, connectivity)
}

#[test]
fn a_grid_that_does_not_fit_is_refused() {
    let sample = Sample::new();
    let refused = |change: &dyn Fn(&mut Grid<'_>)| {
        sample.with_grid(|grid| {
            let mut grid = *grid;
            change(&mut grid);
            encode(&grid, &Options::default()).unwrap_err()
        })
    };
    assert!(matches!(
        refused(&|g| g.points = &[]),
        VtuError::BadCell {
            cell: 0,
            why: "it has a node that is not there",
            ..
        }
    ));
    assert!(matches!(
        refused(&|g| g.types = &[12, 99]),
        VtuError::BadCell {
            cell: 1,
            cell_type: 99,
            ..
        }
    ));
    assert!(matches!(
        refused(&|g| g.types = &[10, 1]),
        VtuError::BadCell { cell: 0, .. }
    ));
    assert!(matches!(
        refused(&|g| g.types = &[12]),
        VtuError::WrongLength { .. }
    ));
    assert!(matches!(
        refused(&|g| g.offsets = &[0, 10, 9]),
        VtuError::BadCell { .. }
    ));
    assert!(matches!(
        refused(&|g| g.offsets = &[]),
        VtuError::WrongLength { .. }
    ));
    assert!(matches!(
        refused(&|g| g.connectivity = &[0]),
        VtuError::WrongLength { .. }
    ));
    assert!(matches!(
        refused(&|g| g.cell_data = const {
            &[Field {
                name: "x",
                values: Values::Scalar(&[1.0]),
                component_names: &[],
            }]
        }),
        VtuError::WrongLength {
            expected: 2,
            got: 1,
            ..
        }
    ));
    assert!(matches!(
        refused(&|g| g.cell_data = const {
            &[Field {
                name: "x",
                values: Values::Int8(&[1, 2]),
                component_names: &["a", "b"],
            }]
        }),
        VtuError::WrongComponentNames {
            expected: 1,
            got: 2,
            ..
        }
    ));
    const TIME: Fact<'static> = Fact {
        name: "TimeValue",
        value: FactValue::Real(&[0.0]),
    };
    assert!(matches!(
        refused(&|g| g.facts = const { &[TIME, TIME] }),
        VtuError::BadName { .. }
    ));
}

#[test]
fn a_file_cut_at_any_length_is_refused() {
    for options in [
        Options::default(),
        Options {
            compression: None,
            ..Options::default()
        },
    ] {
        let bytes = Sample::new().encode(&options);
        for length in 0..bytes.trim_ascii_end().len() {
            assert!(
                read(&bytes[..length]).is_err(),
                "{length} of {} bytes were accepted",
                bytes.len()
            );
        }
    }
}

/// Numbers that look random; the same in every run.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % n
    }
}

#[test]
fn damaged_files_never_panic_and_never_ask_for_much_memory() {
    let sample = Sample::new();
    let mut random = Random(20240607);
    let (mut refused, mut read_anyway) = (0, 0);
    for options in [
        Options::default(),
        Options {
            compression: None,
            long_ids: true,
            ..Options::default()
        },
    ] {
        let original = sample.encode(&options);
        for _ in 0..3000 {
            let mut bytes = original.clone();
            for _ in 0..=random.below(4) {
                let at = random.below(bytes.len());
                match random.below(6) {
                    0 => bytes[at] ^= 1 << random.below(8),
                    1 => bytes[at] = random.below(256) as u8,
                    2 => bytes[at] = b'0' + random.below(10) as u8,
                    3 => bytes.truncate(at.max(1)),
                    4 => bytes.insert(at, b"9<>\"/_\0\xff"[random.below(8)]),
                    _ => {
                        let end = (at + random.below(40)).min(bytes.len());
                        let piece = bytes[at..end].to_vec();
                        let to = random.below(bytes.len());
                        bytes.splice(to..to, piece);
                    }
                }
            }
            match read_limited(&bytes, 1 << 20) {
                Ok(vtu) => {
                    read_anyway += 1;
                    assert!(vtu.connectivity.iter().all(|n| *n < vtu.points.len()));
                    assert!(
                        vtu.offsets.last() == Some(&vtu.connectivity.len())
                            && vtu.offsets.is_sorted()
                    );
                }
                Err(error) => {
                    refused += 1;
                    assert!(!error.to_string().is_empty());
                }
            }
        }
    }
    assert!(
        refused > 2000 && read_anyway > 100,
        "{refused} refused, {read_anyway} read"
    );
}

#[test]
fn a_small_file_that_claims_to_be_large_is_refused_before_memory_is_asked_for() {
    let bytes = Sample::new().encode(&Options::default());
    let text = |from: &str, to: &str| {
        let at = bytes
            .windows(from.len())
            .position(|w| w == from.as_bytes())
            .unwrap();
        [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat()
    };
    for count in [
        "10000000000",
        "18446744073709551615",
        "99999999999999999999",
    ] {
        for name in [
            "NumberOfPoints=\"9\"",
            "NumberOfCells=\"2\"",
            "NumberOfTuples=\"1\"",
        ] {
            let key = name.split_once('"').unwrap().0;
            read(&text(name, &format!("{key}\"{count}\""))).unwrap_err();
        }
        read(&text("offset=\"0\"", &format!("offset=\"{count}\""))).unwrap_err();
    }
    // A header that lies about the size of its pieces, consistent with the tag.
    let zeros = vec![[0.0; 3]; 1 << 20];
    let grid = Grid {
        points: &zeros,
        ..Grid::default()
    };
    let bomb = encode(&grid, &Options::default()).unwrap();
    assert!(bomb.len() < 1 << 20);
    assert!(matches!(
        read_limited(&bomb, 1 << 20),
        Err(VtuReadError::TooLarge { .. })
    ));
    assert_eq!(read(&bomb).unwrap().points.len(), 1 << 20);
}

/// Writes three frames and lists each; goes on after errors as a run would not, to see more.
fn write_frames(fs: &dyn Fs, dir: &Path) -> Vec<Result<(), String>> {
    let sample = Sample::new();
    let mut list = Pvd::new(&dir.join("results.pvd"));
    (0..3)
        .map(|i| {
            let name = format!("volume_{i:04}.vtu");
            sample
                .with_grid(|grid| write(fs, &dir.join(&name), grid, &Options::default()))
                .map_err(|e| e.to_string())?;
            list.add(fs, f64::from(i), &[&name])
                .map_err(|e| e.to_string())
        })
        .collect()
}

/// Every listed frame can be read.
fn assert_consistent(dir: &Path, at_least: usize) {
    match Pvd::read(&RealFs, &dir.join("results.pvd")) {
        Ok(list) => {
            assert!(
                list.entries().len() >= at_least,
                "{} frames listed, {at_least} were complete",
                list.entries().len()
            );
            for entry in list.entries() {
                read(&RealFs.read(&dir.join(&entry.file)).unwrap()).unwrap();
            }
        }
        Err(PvdError::Fs(FsError::NotFound { .. })) => assert_eq!(at_least, 0),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn whichever_operation_fails_the_list_names_only_complete_frames() {
    let dir = tempfile::tempdir().unwrap();
    let counting = FailingFs::counting(RealFs);
    assert!(
        write_frames(&counting, dir.path())
            .iter()
            .all(Result::is_ok)
    );
    let total = counting.count();
    assert_eq!(
        total, 18,
        "write, rename and sync of three frames and three lists"
    );
    for n in 1..=total {
        for forever in [false, true] {
            let dir = tempfile::tempdir().unwrap();
            let fs = match forever {
                true => FailingFs::from_nth(RealFs, n, ErrorKind::StorageFull),
                false => FailingFs::nth(RealFs, n, ErrorKind::StorageFull),
            };
            let results = write_frames(&fs, dir.path());
            let failed: Vec<&String> = results.iter().filter_map(|r| r.as_ref().err()).collect();
            let nfailed = if forever { 3 - (n as usize - 1) / 6 } else { 1 };
            assert_eq!(failed.len(), nfailed, "operation {n}");
            assert!(
                failed[0].contains("disk full while writing"),
                "{}",
                failed[0]
            );
            assert_consistent(dir.path(), 3 - nfailed);
        }
    }
}

#[test]
fn a_power_cut_in_any_write_leaves_the_frames_before_it() {
    for n in 1..=6 {
        for keep in [0, 1, 100, 500, 100_000] {
            let dir = tempfile::tempdir().unwrap();
            let complete = write_frames(&TornFs::nth(RealFs, n, keep), dir.path())
                .iter()
                .filter(|r| r.is_ok())
                .count();
            assert_eq!(complete, (n as usize - 1) / 2);
            assert_consistent(dir.path(), complete);
        }
    }
}

#[test]
fn a_list_torn_by_a_lying_disk_is_refused_and_built_again() {
    let dir = tempfile::tempdir().unwrap();
    let path = dir.path().join("results.pvd");
    let before = write_frames(&TornFs::lying(RealFs, 4, 150, 1), dir.path());
    assert_eq!(before.iter().filter(|r| r.is_ok()).count(), 1);
    assert!(matches!(
        Pvd::resume(&RealFs, &path, 1.0),
        Err(PvdError::Damaged { .. })
    ));
    let entry = |i: u8| crate::writers::pvd::Entry {
        time: f64::from(i),
        part: 0,
        file: format!("volume_000{i}.vtu"),
    };
    Pvd::with_entries(&RealFs, &path, vec![entry(0), entry(1)]).unwrap();
    assert_consistent(dir.path(), 2);
}

/// Writes a frame and what a viewer must see in it.
fn write_sample(stem: &str, grid: &Grid<'_>, options: &Options, expected: &serde_json::Value) {
    let folder = std::env::var_os("SIGNORINI_SAMPLES").map_or_else(
        || std::env::temp_dir().join("signorini-samples"),
        std::path::PathBuf::from,
    );
    RealFs.create_dir_all(&folder).unwrap();
    write(&RealFs, &folder.join(format!("{stem}.vtu")), grid, options).unwrap();
    let expected = serde_json::to_vec_pretty(expected).unwrap();
    RealFs
        .write_atomic(&folder.join(format!("{stem}.json")), &expected)
        .unwrap();
}

/// Writes `sample_*.vtu` and `sample_*.json` for `scripts/check_vtu.py` into the folder SIGNORINI_SAMPLES.
#[test]
#[ignore = "writes files for viewers: into the folder SIGNORINI_SAMPLES, else a temporary one"]
fn samples_for_viewers_are_written() {
    let sample = Sample::new();
    let stress: Vec<f64> = sample
        .stress
        .iter()
        .flat_map(|t| [t.xx, t.yy, t.zz, t.xy, t.yz, t.xz])
        .collect();
    for options in all_options() {
        let level = options
            .compression
            .map_or("raw".to_string(), |level| format!("zlib{level}"));
        let (real, reals) = if options.single {
            ("float", "f32")
        } else {
            ("double", "f64")
        };
        let ids = if options.long_ids { "i64" } else { "i32" };
        let stored = |v: &[f64]| -> Vec<f64> {
            v.iter()
                .map(|v| {
                    if options.single {
                        f64::from(*v as f32)
                    } else {
                        *v
                    }
                })
                .collect()
        };
        let mut expected = json!({
            "points": stored(sample.points.as_flattened()),
            "types": TYPES,
            "cells": [&CONNECTIVITY[..8], &CONNECTIVITY[8..]],
            "active_vectors": "displacement",
            "point_data": {
                "contact_status": { "values": sample.status, "type": "signed char" },
                "displacement": { "values": stored(sample.displacement.as_flattened()), "type": real },
                "contact_pressure": { "values": stored(&sample.pressure), "type": real },
            },
            "cell_data": {
                "stress": { "values": stored(&stress), "type": real, "components": TENSOR_COMPONENTS },
                "body": { "values": sample.body },
                "element <&\"id\">": { "values": sample.element },
            },
            "field_data": { "TimeValue": { "values": [0.1 + 0.2] }, "step": { "values": [2] } },
        });
        // Text only with long numbers, since meshio refuses any file with text.
        let nfact = if options.long_ids { 3 } else { 2 };
        if options.long_ids {
            expected["field_data"]["step_name"] = json!({ "text": "drück <1>" });
        }
        sample.with_grid(|grid| {
            let grid = Grid {
                facts: &grid.facts[..nfact],
                ..*grid
            };
            write_sample(
                &format!("sample_{reals}_{level}_{ids}"),
                &grid,
                &options,
                &expected,
            );
        });
    }
}

#[test]
#[ignore = "writes files for viewers: into the folder SIGNORINI_SAMPLES, else a temporary one"]
fn samples_of_cell_types_and_sizes_are_written() {
    let options = Options::default();
    write_sample(
        "sample_empty",
        &Grid::default(),
        &options,
        &json!({ "points": [], "types": [] }),
    );

    let (types, offsets, connectivity) = one_cell_of_every_type();
    let points: Vec<[f64; 3]> = (0..27)
        .map(|i| [f64::from(i), f64::from(i * i), 0.0])
        .collect();
    let cells: Vec<&[u32]> = offsets
        .windows(2)
        .map(|w| &connectivity[w[0]..w[1]])
        .collect();
    let expected = json!({ "types": types, "cells": cells, "points": points });
    let grid = Grid {
        points: &points,
        types: &types,
        offsets: &offsets,
        connectivity: &connectivity,
        ..Grid::default()
    };
    write_sample("sample_every_cell_type", &grid, &options, &expected);

    // Vertices in several compressed pieces.
    let n = 40_000;
    let points: Vec<[f64; 3]> = (0..n)
        .map(|i| [0.1 * i as f64, (i as f64).sin(), 0.0])
        .collect();
    let (offsets, connectivity): (Vec<usize>, Vec<u32>) =
        ((0..=n).collect(), (0..n as u32).collect());
    let grid = Grid {
        points: &points,
        types: &vec![1; n],
        offsets: &offsets,
        connectivity: &connectivity,
        ..Grid::default()
    };
    write_sample(
        "sample_many_vertices",
        &grid,
        &options,
        &json!({ "points": points, "types": vec![1; n] }),
    );
}
