//! Tables as Markdown has them, aligned, so that they read well in a terminal too.

/// Rows of cells below a head; the first column is text, the others are numbers.
#[derive(Debug)]
pub struct Table {
    rows: Vec<Vec<String>>,
}

impl Table {
    /// A table with this head.
    pub fn new<const N: usize>(head: [&str; N]) -> Self {
        Self {
            rows: vec![head.map(String::from).to_vec()],
        }
    }

    /// A table with as many columns as its head has words.
    pub fn of(head: Vec<String>) -> Self {
        Self { rows: vec![head] }
    }

    /// Adds a row to such a table; it has as many cells as the head.
    pub fn add_row(&mut self, row: Vec<String>) {
        self.rows.push(row);
    }

    /// Adds a row, of as many cells as the head.
    pub fn add<const N: usize>(&mut self, row: [String; N]) {
        self.rows.push(row.to_vec());
    }

    /// True if there is only a head.
    pub fn is_empty(&self) -> bool {
        self.rows.len() < 2
    }
}

impl std::fmt::Display for Table {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let columns = self.rows[0].len();
        let width = |column: usize| {
            let cells = self.rows.iter().map(|row| row[column].chars().count());
            cells.max().unwrap_or(0).max(3)
        };
        let widths: Vec<usize> = (0..columns).map(width).collect();
        for (number, row) in self.rows.iter().enumerate() {
            let cells = row.iter().zip(&widths).enumerate();
            for (column, (cell, &width)) in cells {
                if column == 0 {
                    write!(f, "| {cell:width$} ")?;
                } else {
                    write!(f, "| {cell:>width$} ")?;
                }
            }
            writeln!(f, "|")?;
            if number == 0 {
                write!(f, "|{}", "-".repeat(widths[0] + 2))?;
                for width in &widths[1..] {
                    write!(f, "|{}:", "-".repeat(width + 1))?;
                }
                writeln!(f, "|")?;
            }
        }
        Ok(())
    }
}

/// A number with three significant digits and a prefix: 12.3 k, 4.56 M, 789 µ.
pub fn short(number: f64) -> String {
    if number == 0.0 || !number.is_finite() {
        return format!("{number} ");
    }
    let prefixes = ["n", "µ", "m", "", "k", "M", "G", "T"];
    let power = ((number.abs().log10() + 1e-9).floor() / 3.0).floor();
    let place = (power + 3.0).clamp(0.0, 7.0);
    let scaled = number / 1000f64.powf(place - 3.0);
    let digits = match scaled.abs() {
        size if size >= 99.95 => 0,
        size if size >= 9.995 => 1,
        _ => 2,
    };
    format!("{scaled:.digits$} {}", prefixes[place as usize])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_aligned_below_their_head() {
        let mut table = Table::new(["what", "s"]);
        assert!(table.is_empty());
        table.add(["µ-sweeps".into(), "1.5".into()]);
        table.add(["W".into(), "12.25".into()]);
        let text = "\
| what     |     s |
|----------|------:|
| µ-sweeps |   1.5 |
| W        | 12.25 |
";
        assert_eq!(table.to_string(), text);
    }

    #[test]
    fn numbers_have_three_digits_and_a_prefix() {
        for (number, text) in [
            (0.0425, "42.5 m"),
            (1.0, "1.00 "),
            (999.0, "999 "),
            (1000.0, "1.00 k"),
            (23_456_789.0, "23.5 M"),
            (9.9e-9, "9.90 n"),
            (-5.2e-5, "-52.0 µ"),
            (0.0, "0 "),
        ] {
            assert_eq!(short(number), text);
        }
    }
}
