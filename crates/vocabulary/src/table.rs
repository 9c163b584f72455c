//! Tables, keys and the forms of their values.

/// A table of a case: what may stand in it.
#[derive(Clone, Copy, Debug)]
pub struct Table {
    /// How users write it, as in `[[contact]]`.
    pub heading: &'static str,
    /// What it is.
    pub doc: &'static str,
    /// Its keys, in the order in which they are listed and written.
    pub keys: &'static [Key],
    /// Which keys exclude or need each other.
    pub rules: &'static [Rule],
}

impl Table {
    /// The entry of a key.
    pub fn key(&self, name: &str) -> Option<&'static Key> {
        self.keys.iter().find(|key| key.name == name)
    }

    /// The names of all keys this version reads.
    pub fn names(&self) -> impl Iterator<Item = &'static str> + Clone + use<> {
        self.keys
            .iter()
            .filter(|key| key.later.is_none())
            .map(|key| key.name)
    }
}

/// A key of a table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    /// Its name.
    pub name: &'static str,
    /// The form of its value.
    pub shape: Shape,
    /// What holds where it is absent.
    pub default: Default,
    /// What it means, in one line.
    pub doc: &'static str,
    /// Other words people use for it; they are proposed, never read.
    pub hints: &'static [&'static str],
    /// Known, but not supported by this version: what to use instead, which may be empty.
    pub later: Option<&'static str>,
    /// What a vector may be in a model of the plane.
    pub plane: InPlane,
}

/// What a vector may be in a model of the plane, where it may have two entries in place of three.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InPlane {
    /// Any vector.
    Any,
    /// One in the plane: z = 0.
    Within,
    /// One along z.
    Across,
}

impl Key {
    /// The same key, which must be given.
    #[must_use]
    pub const fn required(mut self) -> Self {
        self.default = Default::Required;
        self
    }

    /// The same key with a default.
    #[must_use]
    pub const fn or(mut self, default: Default) -> Self {
        self.default = default;
        self
    }

    /// The same key with other words that people use for it.
    #[must_use]
    pub const fn hints(mut self, hints: &'static [&'static str]) -> Self {
        self.hints = hints;
        self
    }

    /// The same key, a vector that lies in the plane of a plane model.
    #[must_use]
    pub const fn within_plane(mut self) -> Self {
        self.plane = InPlane::Within;
        self
    }

    /// The same key, a vector along z in a plane model.
    #[must_use]
    pub const fn across_plane(mut self) -> Self {
        self.plane = InPlane::Across;
        self
    }

    /// The same key, known but not supported by this version: what to use instead.
    #[must_use]
    pub const fn later(mut self, instead: &'static str) -> Self {
        self.later = Some(instead);
        self
    }
}

/// An optional key without a default.
#[must_use]
pub const fn key(name: &'static str, shape: Shape, doc: &'static str) -> Key {
    Key {
        name,
        shape,
        default: Default::Absent,
        doc,
        hints: &[],
        later: None,
        plane: InPlane::Any,
    }
}

/// What holds where a key is absent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Default {
    /// It must be given.
    Required,
    /// Nothing.
    Absent,
    /// A text or word.
    Text(&'static str),
    /// Several texts or words.
    Texts(&'static [&'static str]),
    /// A number.
    Number(f64),
    /// A list of numbers, such as a vector.
    Numbers(&'static [f64]),
    /// A whole number.
    Integer(i64),
    /// A truth value.
    Flag(bool),
}

/// The form of a value.
#[derive(Clone, Copy, Debug)]
pub enum Shape {
    /// Any text.
    Text,
    /// One of these words.
    Choice(&'static [Choice]),
    /// A finite number in a range.
    Number(Bounds),
    /// A whole number from the first to the second.
    Integer(i64, i64),
    /// `true` or `false`.
    Flag,
    /// A list of values of one form: at least and at most so many.
    List(&'static Shape, usize, usize),
    /// A list of values of these forms, and how it is written, as in `[element, side]`.
    Row(&'static str, &'static [Shape]),
    /// A value of one of these forms, which differ in their TOML type.
    Either(&'static [Shape]),
    /// A table.
    Table(&'static Table),
    /// A list of tables.
    Tables(&'static Table),
    /// A table of tables by names of the user's choice.
    Named(&'static Table),
    /// The rows `[id, x, y, z]` of nodes, which are too many for the ordinary way.
    Nodes,
    /// A form that this version does not support: what to use instead.
    Later(&'static Shape, &'static str),
}

/// A word that a key takes.
#[derive(Clone, Copy, Debug)]
pub struct Choice {
    /// The word.
    pub word: &'static str,
    /// Known, but not supported by this version: what to use instead, which may be empty.
    pub later: Option<&'static str>,
}

impl Choice {
    /// A word that this version does not support: what to use instead.
    #[must_use]
    pub const fn later(word: &'static str, instead: &'static str) -> Self {
        Self {
            word,
            later: Some(instead),
        }
    }
}

/// A word that is supported.
#[must_use]
pub const fn word(word: &'static str) -> Choice {
    Choice { word, later: None }
}

/// The range of a number: exclusive (`above`, `below`) or inclusive (`from`, `to`) ends.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Greater than this.
    pub above: Option<f64>,
    /// At least this.
    pub from: Option<f64>,
    /// Less than this.
    pub below: Option<f64>,
    /// At most this.
    pub to: Option<f64>,
}

impl Bounds {
    /// Whether a number lies in the range.
    ///
    /// # Example
    /// ```
    /// use signorini_vocabulary::{Bounds, FREE};
    ///
    /// let poisson = Bounds { above: Some(-1.0), below: Some(0.5), ..FREE };
    /// assert!(poisson.hold(0.3) && !poisson.hold(0.5));
    /// ```
    pub fn hold(&self, value: f64) -> bool {
        self.above.is_none_or(|end| value > end)
            && self.from.is_none_or(|end| value >= end)
            && self.below.is_none_or(|end| value < end)
            && self.to.is_none_or(|end| value <= end)
    }

    /// The range in words, as in `greater than 0`.
    pub fn words(&self) -> String {
        let ends = [
            ("greater than", self.above),
            ("at least", self.from),
            ("less than", self.below),
            ("at most", self.to),
        ];
        let words: Vec<String> = ends
            .into_iter()
            .filter_map(|(words, end)| end.map(|end| format!("{words} {end}")))
            .collect();
        words.join(" and ")
    }
}

/// Keys that exclude or need each other.
#[derive(Clone, Copy, Debug)]
pub enum Rule {
    /// Exactly one of these.
    ExactlyOne(&'static [&'static str]),
    /// At least one of these.
    AtLeastOne(&'static [&'static str]),
    /// At most one of these.
    AtMostOne(&'static [&'static str]),
    /// The first only together with the second.
    Needs(&'static str, &'static str),
    /// Either the first, or all of the others and not the first.
    Instead(&'static str, &'static [&'static str]),
    /// Both numbers: the first is at most the second.
    NotAbove(&'static str, &'static str),
    /// Both numbers: the first is less than the second.
    Below(&'static str, &'static str),
}

/// Any number.
pub const FREE: Bounds = Bounds {
    above: None,
    from: None,
    below: None,
    to: None,
};
/// A number.
pub const ANY: Shape = Shape::Number(FREE);
/// A number greater than zero.
pub const POSITIVE: Shape = Shape::Number(Bounds {
    above: Some(0.0),
    ..FREE
});
/// A number that is not negative.
pub const NOT_NEGATIVE: Shape = Shape::Number(Bounds {
    from: Some(0.0),
    ..FREE
});
/// Poisson's ratio of an isotropic material.
pub const POISSON: Shape = Shape::Number(Bounds {
    above: Some(-1.0),
    below: Some(0.5),
    ..FREE
});
/// No upper limit of a length.
pub const MANY: usize = usize::MAX;
/// Three numbers; two will do in the plane.
pub const VECTOR: Shape = Shape::List(&ANY, 2, 3);
/// One of the axes of the frame.
pub const AXIS: Shape = Shape::Choice(&[word("x"), word("y"), word("z")]);
/// An axis of the frame, or a vector along any other.
pub const LINE: Shape = Shape::Either(&[AXIS, VECTOR]);
