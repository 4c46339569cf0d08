//! What a misspelt word may have meant.

/// The nearest of several names, if it is near enough to be meant.
pub(super) fn nearest<'n>(word: &str, names: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let limit = 1 + word.chars().count() / 4;
    names
        .map(|name| (strsim::levenshtein(word, name), name))
        .filter(|(distance, _)| *distance <= limit)
        .min()
        .map(|(_, name)| name)
}
