//! Grids written by VTK itself and by meshio (see `data/make_vtu.py`), and by the writer here; and damaged ones.

#![allow(clippy::unwrap_used)]

use signorini_geometry::element::by_name;
use signorini_geometry::mesh::Mesh;
use signorini_geometry::tensor::Vec3;
use signorini_io::readers::{MeshError, read_mesh, validate};
use signorini_io::writers::vtu::{Field, Grid, Options, Values, encode};
use std::path::{Path, PathBuf};

fn files() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data");
    let entries = std::fs::read_dir(folder).unwrap();
    let mut files: Vec<PathBuf> = (entries.map(|entry| entry.unwrap().path()))
        .filter(|path| path.extension().is_some_and(|e| e == "vtu"))
        .collect();
    files.sort();
    files
}

fn labels(mesh: &Mesh, set: &str) -> Vec<u64> {
    let cells = mesh.sets[set].cells.iter();
    let mut labels: Vec<u64> = cells.map(|&cell| mesh.cell_label(cell).unwrap()).collect();
    labels.sort_unstable();
    labels
}

#[test]
fn every_way_to_store_a_grid_gives_the_same_mesh() {
    let files = files();
    assert_eq!(files.len(), 20);
    for path in files {
        let name = path.file_name().unwrap().to_str().unwrap();
        let read = read_mesh(name, &std::fs::read(&path).unwrap());
        if by_name("tet10").is_none() {
            let error = read.unwrap_err().to_string();
            assert!(error.contains("VTK type 24, such as 5"), "{error}");
            continue;
        }
        let (mesh, notes) = read.unwrap();
        assert_eq!((mesh.nnode(), mesh.ncell()), (25, 5), "{name}");
        assert_eq!(validate(&mesh), [], "{name}");
        assert_eq!(labels(&mesh, "MaterialIDs_1"), [1, 2], "{name}");
        assert_eq!(labels(&mesh, "MaterialIDs_2"), [3, 4], "{name}");
        assert_eq!(labels(&mesh, "MaterialIDs_5"), [5], "{name}");
        assert_eq!(mesh.sets["foot_1"].nodes, [0, 1, 2, 3, 4, 5], "{name}");
        assert_eq!(mesh.sets["foot_0"].nodes.len(), 19, "{name}");
        assert_eq!(mesh.sets.len(), 5, "{name}");
        assert_eq!(mesh.points[18].to_array(), [0.5, 0.5, 3.0], "{name}");
        assert!(notes.len() < 2, "{notes:?}");
    }
}

/// Bytes that reading a damaged grid may allocate, all together; the whole ones have some 10 kB.
const MOST: u64 = 1 << 20;

/// Two bricks, by the writer here.
fn written(options: &Options) -> Vec<u8> {
    let points: Vec<[f64; 3]> = (0..12)
        .map(|i| [f64::from(i % 2), f64::from(i / 2 % 2), f64::from(i / 4)])
        .collect();
    let connectivity = [0, 1, 3, 2, 4, 5, 7, 6, 4, 5, 7, 6, 8, 9, 11, 10];
    let ids = [7, 9];
    let bodies = [0, 1];
    let heat = [0.5; 12];
    let cell_data = [
        Field::new("element_id", Values::Int64(&ids)),
        Field::new("body", Values::Int32(&bodies)),
    ];
    let point_data = [Field::new("heat", Values::Scalar(&heat))];
    let grid = Grid {
        points: &points,
        types: &[12, 12],
        offsets: &[0, 8, 16],
        connectivity: &connectivity,
        point_data: &point_data,
        cell_data: &cell_data,
        facts: &[],
    };
    encode(&grid, options).unwrap()
}

#[test]
fn what_is_written_here_is_read_with_its_numbers_and_groups() {
    for single in [false, true] {
        for compression in [None, Some(1), Some(9)] {
            for long_ids in [false, true] {
                let options = Options {
                    single,
                    compression,
                    long_ids,
                };
                let (mesh, _) = read_mesh("a.vtu", &written(&options)).unwrap();
                assert_eq!((mesh.nnode(), mesh.ncell()), (12, 2));
                assert_eq!(mesh.points[11], Vec3::new(1.0, 1.0, 2.0));
                assert_eq!(labels(&mesh, "body_0"), [7]);
                assert_eq!(labels(&mesh, "body_1"), [9]);
                assert_eq!(validate(&mesh), []);
            }
        }
    }
}

#[test]
fn lying_sizes_are_refused_before_memory_is_asked_for() {
    let text = |points: &str, types: &str, header: &str| {
        format!(
            "<VTKFile type=\"UnstructuredGrid\" byte_order=\"LittleEndian\" {header}><UnstructuredGrid>\
             <Piece NumberOfPoints=\"100000000\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" \
             NumberOfComponents=\"3\" format={points}</DataArray></Points><Cells><DataArray type=\"UInt8\" \
             Name=\"types\" format={types}</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>"
        )
    };
    let wide = "header_type=\"UInt64\"";
    let zlib = "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\"";
    // 3 · 8 · 10^8 bytes, as UInt64 in base64: in one block, and in one compressed piece of 16 bytes
    let plain = "\"binary\">AFgNjwAAAAA=";
    let bomb = "\"binary\">AQAAAAAAAAAAWA2PAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA=";
    for file in [
        text("\"ascii\">0 0 0", "\"ascii\">12", wide),
        text(plain, "\"ascii\">12", wide),
        text(bomb, "\"ascii\">12", zlib),
        text("\"appended\" offset=\"99999999999\">", "\"ascii\">12", wide),
    ] {
        for count in ["100000000", "3", "18446744073709551615", "-1", "1e9"] {
            let file = file.replace("100000000", count);
            let mut read = None;
            let taken = allocation_counter::measure(|| {
                read = Some(read_mesh("a.vtu", file.as_bytes()));
            });
            let error = read.unwrap().unwrap_err();
            assert!(matches!(error, MeshError::Vtu { .. }), "{error}");
            assert!(error.to_string().starts_with("a.vtu: "));
            assert!(taken.bytes_total < 1 << 20, "{count}: {taken:?}");
        }
    }
}

#[test]
fn four_thousand_damaged_grids_end_in_a_mesh_or_an_error_and_take_little_memory() {
    let mut originals: Vec<Vec<u8>> = files().iter().map(|p| std::fs::read(p).unwrap()).collect();
    originals.push(written(&Options::default()));
    let mut state = 11_u64;
    let mut below = |n: usize| {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % n.max(1)
    };
    const WORDS: [&[u8]; 12] = [
        b"\"9999999999\"",
        b"\"-1\"",
        b"Float64",
        b"Int8",
        b"UInt64",
        b"binary",
        b"ascii",
        b"<",
        b"/>",
        b"\"",
        b"=",
        b"AAAA",
    ];
    let (mut good, mut bad, mut most) = (0, 0, 0);
    for i in 0..4000 {
        let mut bytes = originals[i % originals.len()].clone();
        for _ in 0..=below(3) {
            let at = below(bytes.len());
            match below(6) {
                0 => bytes.truncate(at),
                1 => bytes[at..]
                    .iter_mut()
                    .take(1)
                    .for_each(|b| *b ^= 1 << below(8)),
                2 => bytes[at..]
                    .iter_mut()
                    .take(1)
                    .for_each(|b| *b = b"0123456789AZaz+/"[below(16)]),
                3 => {
                    let word = WORDS[below(WORDS.len())];
                    let end = (at + below(2) * word.len()).min(bytes.len());
                    bytes.splice(at..end, word.iter().copied());
                }
                4 => {
                    let end = (at + below(80)).min(bytes.len());
                    let piece = bytes[at..end].to_vec();
                    let to = below(bytes.len());
                    bytes.splice(to..to, piece);
                }
                _ => {
                    let end = (at + below(80)).min(bytes.len());
                    bytes.drain(at..end);
                }
            }
            if bytes.is_empty() {
                break;
            }
        }
        let mut read = None;
        let taken = allocation_counter::measure(|| read = Some(read_mesh("a.vtu", &bytes)));
        most = most.max(taken.bytes_total);
        match read.unwrap() {
            Ok((mesh, _)) => {
                good += 1;
                let nnode = mesh.nnode() as u32;
                assert!(
                    mesh.blocks
                        .iter()
                        .flat_map(|b| &b.nodes)
                        .all(|&n| n < nnode)
                );
            }
            Err(error) => {
                bad += 1;
                assert!(error.to_string().starts_with("a.vtu"), "{error}");
            }
        }
    }
    println!("{good} meshes, {bad} errors, at most {most} bytes");
    assert!(
        bad > 1000 && good + bad == 4000,
        "{good} meshes, {bad} errors"
    );
    assert!(most < MOST, "{most}");
}
