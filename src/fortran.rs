//! Numbers as Fortran writes them.

/// A number with an exponent after E or D; `None` where it is none, or not finite.
pub fn number(word: &str) -> Option<f64> {
    let number: f64 = word.replace(['D', 'd'], "E").parse().ok()?;
    number.is_finite().then_some(number)
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn exponents_follow_e_or_d_and_what_is_not_finite_is_no_number() {
        assert_eq!(number("1.5D-3"), Some(1.5e-3));
        assert_eq!(number("2d3"), Some(2e3));
        assert_eq!(number("-4E2"), Some(-400.0));
        assert_eq!(number("nan"), None);
        assert_eq!(number("1e999"), None);
        assert_eq!(number("3,621"), None);
    }
}
