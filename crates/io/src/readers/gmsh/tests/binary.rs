//! Text meshes as binary data.

use super::super::kind::Kind;

/// Rewrites a text mesh as binary data, number by number, in the widths that the format prescribes.
struct BinaryWriter<'a> {
    words: std::str::SplitWhitespace<'a>,
    out: Vec<u8>,
    big_endian: bool,
    wide: bool,
}

impl BinaryWriter<'_> {
    fn put<const N: usize>(&mut self, little: [u8; N]) {
        let mut bytes = little;
        if self.big_endian {
            bytes.reverse();
        }
        self.out.extend(bytes);
    }

    fn int(&mut self) -> i32 {
        let value: i32 = self.words.next().unwrap().parse().unwrap();
        self.put(value.to_le_bytes());
        value
    }

    fn size(&mut self) -> u64 {
        let value: u64 = self.words.next().unwrap().parse().unwrap();
        if self.wide {
            self.put(value.to_le_bytes());
        } else {
            self.put((value as u32).to_le_bytes());
        }
        value
    }

    fn reals(&mut self, n: u64) {
        for _ in 0..n {
            let value: f64 = self.words.next().unwrap().parse().unwrap();
            self.put(value.to_le_bytes());
        }
    }

    fn ints(&mut self, n: u64) {
        (0..n).for_each(|_| _ = self.int());
    }

    fn v2_nodes(&mut self) {
        let n: u64 = self.words.next().unwrap().parse().unwrap();
        self.out.extend(format!("{n}\n").bytes());
        for _ in 0..n {
            self.int();
            self.reals(3);
        }
    }

    fn v2_elements(&mut self) {
        let n: u64 = self.words.next().unwrap().parse().unwrap();
        self.out.extend(format!("{n}\n").bytes());
        for _ in 0..n {
            let [label, kind, ntag] =
                [0; 3].map(|_: i32| self.words.next().unwrap().parse::<i32>().unwrap());
            for header in [kind, 1, ntag, label] {
                self.put(header.to_le_bytes());
            }
            let nnode = Kind::find(kind.into()).unwrap().nnode as u64;
            self.ints(ntag as u64 + nnode);
        }
    }

    fn v4_entities(&mut self) {
        let counts = [0; 4].map(|_: u64| self.size());
        for (dim, count) in counts.into_iter().enumerate() {
            for _ in 0..count {
                self.int();
                self.reals(if dim == 0 { 3 } else { 6 });
                for _ in 0..=usize::from(dim > 0) {
                    let n = self.size();
                    self.ints(n);
                }
            }
        }
    }

    fn v4_nodes(&mut self) {
        let nblock = self.size();
        (0..3).for_each(|_| _ = self.size());
        for _ in 0..nblock {
            let dim = self.int() as u64;
            self.int();
            let parametric = self.int() as u64;
            let n = self.size();
            (0..n).for_each(|_| _ = self.size());
            self.reals(n * (3 + parametric * dim));
        }
    }

    fn v4_elements(&mut self) {
        let nblock = self.size();
        (0..3).for_each(|_| _ = self.size());
        for _ in 0..nblock {
            self.ints(2);
            let nnode = Kind::find(self.int().into()).unwrap().nnode as u64;
            let n = self.size();
            (0..n * (1 + nnode)).for_each(|_| _ = self.size());
        }
    }
}

pub(super) fn to_binary(text: &str, big_endian: bool, wide: bool) -> Vec<u8> {
    let mut out = Vec::new();
    let mut rest = text;
    while let Some((name, after)) = rest.strip_prefix('$').and_then(|r| r.split_once('\n')) {
        let end = format!("$End{name}\n");
        let (body, after) = after.split_once(&end).unwrap();
        rest = after;
        out.extend(format!("${name}\n").bytes());
        let mut writer = BinaryWriter {
            words: body.split_whitespace(),
            out: Vec::new(),
            big_endian,
            wide,
        };
        let v2 = text.contains("\n2.2 ");
        match name {
            "MeshFormat" => {
                let version = writer.words.next().unwrap();
                let width = if wide { 8 } else { 4 };
                writer.out.extend(format!("{version} 1 {width}\n").bytes());
                writer.put(1_i32.to_le_bytes());
            }
            "Entities" => writer.v4_entities(),
            "Nodes" if v2 => writer.v2_nodes(),
            "Nodes" => writer.v4_nodes(),
            "Elements" if v2 => writer.v2_elements(),
            "Elements" => writer.v4_elements(),
            _ => writer.out.extend(body.trim_end().bytes()),
        }
        out.append(&mut writer.out);
        out.extend(format!("\n{end}").bytes());
    }
    out
}
