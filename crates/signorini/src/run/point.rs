//! The integration point that an expectation names.

/// The element and the point, from 1, that an expectation names: `stress.yy @ element 7 point 3`.
#[must_use]
pub fn element_named(what: &str) -> Option<(u64, u64)> {
    let (_, place) = what.split_once('@')?;
    let mut words = place.split_whitespace();
    let element = words.next().filter(|word| *word == "element");
    let label = element.and_then(|_| words.next()?.parse().ok())?;
    let point = match (words.next(), words.next()) {
        (None, _) => 1,
        (Some("point"), Some(number)) => number.parse().ok()?,
        _ => return None,
    };
    words.next().is_none().then_some((label, point))
}
