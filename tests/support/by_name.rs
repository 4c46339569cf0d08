//! Tests that strike at random: how often, from which seed, and whether at all.

/// What the command line of a test program says.
pub struct Orders {
    pub kills: u64,
    pub seed: u64,
    /// Number of the first one: with its seed and number a trial is repeated.
    pub first: u64,
}

impl Orders {
    pub fn numbers(&self) -> std::ops::Range<u64> {
        self.first..self.first.saturating_add(self.kills)
    }
}

/// What to do; nothing where `cargo test` lists tests or asks for others. `few` trials and `seed`, from
/// the first on, unless `--kills`, `--seed` and `--from` say otherwise.
pub fn orders(name: &str, few: u64, seed: u64) -> Option<Orders> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let value = |option: &str| -> Option<u64> {
        let at = words.iter().position(|word| word == option)?;
        words.get(at + 1)?.parse().ok()
    };
    let told = words.iter().any(|word| word == "--kills");
    let mut filters = words.iter().filter(|word| !word.starts_with('-'));
    let named = filters.clone().next().is_none() || filters.any(|word| name.contains(&**word));
    if !(named || told) || words.iter().any(|word| word == "--list") {
        return None;
    }
    Some(Orders {
        kills: value("--kills").unwrap_or(few),
        seed: value("--seed").unwrap_or(seed),
        first: value("--from").unwrap_or(0),
    })
}
