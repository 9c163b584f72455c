//! Fields of results with the ranges of their components.

use serde::Serialize;
use signorini::text::{plural, short};
use signorini_io::readers::frd::Dataset;
use signorini_io::writers::vtu::{TENSOR_COMPONENTS, Vtu};

/// A field with its ranges.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Field {
    name: String,
    /// `node` or `cell`.
    on: &'static str,
    /// At how many nodes there are values, where that may be fewer than all.
    #[serde(skip_serializing_if = "Option::is_none")]
    count: Option<usize>,
    components: Vec<Range>,
}

/// Smallest and largest number of a component; numbers that are none are left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
struct Range {
    /// Empty for a scalar.
    name: String,
    /// None where the component has no numbers.
    range: Option<[f64; 2]>,
}

/// The arrays of a grid.
pub fn of_grid(grid: &Vtu) -> Vec<Field> {
    let mut fields = Vec::new();
    for (on, arrays) in [("node", &grid.point_data), ("cell", &grid.cell_data)] {
        for array in arrays {
            let names = array.component_names.clone();
            fields.push(Field {
                name: array.name.clone(),
                on,
                count: None,
                components: ranges(&array.numbers.to_f64(), array.ncomponent, names),
            });
        }
    }
    fields
}

/// A data set of a file of all frames.
pub fn of_dataset(dataset: &Dataset) -> Field {
    let names = dataset.components.clone();
    Field {
        name: dataset.name.clone(),
        on: "node",
        count: Some(dataset.nodes.len()),
        components: ranges(&dataset.values, names.len(), names),
    }
}

/// Names of the components of vectors and symmetric tensors, as viewers have them.
fn usual_names(ncomponent: usize) -> &'static [&'static str] {
    match ncomponent {
        2 | 3 => &["x", "y", "z"],
        6 => &TENSOR_COMPONENTS,
        _ => &[],
    }
}

fn ranges(values: &[f64], ncomponent: usize, names: Vec<String>) -> Vec<Range> {
    let name = |k: usize| match (names.get(k), usual_names(ncomponent).get(k)) {
        _ if ncomponent == 1 => String::new(),
        (Some(given), _) if !given.is_empty() => given.clone(),
        (_, Some(usual)) => (*usual).to_owned(),
        _ => k.to_string(),
    };
    let component = |k: usize| Range {
        name: name(k),
        range: range(values.iter().skip(k).step_by(ncomponent.max(1))),
    };
    (0..ncomponent).map(component).collect()
}

fn range<'a>(values: impl Iterator<Item = &'a f64>) -> Option<[f64; 2]> {
    let finite = values.filter(|value| value.is_finite());
    finite.fold(None, |range: Option<[f64; 2]>, &value| {
        let [low, high] = range.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    })
}

impl Field {
    /// What there is to say: a line, and one for each component where there are several.
    pub fn lines(&self) -> Vec<String> {
        let words = |range: &Range| match range.range {
            Some([low, high]) => format!("{} to {}", short(low), short(high)),
            None => "no numbers".to_owned(),
        };
        let on = self.count.map(|n| plural(n, self.on));
        let on = on.unwrap_or_else(|| self.on.to_owned());
        match self.components.as_slice() {
            [only] => vec![format!("  {} ({on}): {}", self.name, words(only))],
            several => {
                let head = format!("  {} ({on}, {} components)", self.name, several.len());
                let of = |one: &Range| format!("    {:<4} {}", one.name, words(one));
                std::iter::once(head)
                    .chain(several.iter().map(of))
                    .collect()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_of_vectors_and_tensors_have_their_names_and_ranges() {
        let field = Field {
            name: "displacement".into(),
            on: "node",
            count: None,
            components: ranges(&[1.0, f64::NAN, 3.0, -1.0, f64::NAN, 5.0], 3, Vec::new()),
        };
        let wanted = [
            "  displacement (node, 3 components)",
            "    x    -1.00 to 1.00",
            "    y    no numbers",
            "    z    3.00 to 5.00",
        ];
        assert_eq!(field.lines(), wanted);
        let tensor = ranges(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0], 6, Vec::new());
        let names: Vec<&str> = tensor.iter().map(|one| one.name.as_str()).collect();
        assert_eq!(names, ["XX", "YY", "ZZ", "XY", "YZ", "XZ"]);
        let given = ranges(&[1.0, 2.0], 2, vec!["min".into(), "max".into()]);
        assert_eq!(given[1].name, "max");
        assert_eq!(given[1].range, Some([2.0, 2.0]));
    }
}
