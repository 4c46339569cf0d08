//! Rust source as words: without comments, without what only tests compile, with the public types that it
//! defines.

/// Words of a source file: names, `::`, single signs and `"text"`; no comments, no lifetimes, no characters.
/// What stands under `#[cfg(test)]` is left out.
pub fn words(text: &str) -> Vec<String> {
    without_tests(&all_words(text))
}

fn all_words(text: &str) -> Vec<String> {
    let letters: Vec<char> = text.chars().collect();
    let at = |i: usize| letters.get(i).copied().unwrap_or('\n');
    let of_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut words = Vec::new();
    let mut i = 0;
    while i < letters.len() {
        let (begin, c) = (i, at(i));
        if c == '/' && at(i + 1) == '/' {
            while i < letters.len() && at(i) != '\n' {
                i += 1;
            }
        } else if c == '/' && at(i + 1) == '*' {
            i += 2;
            while i < letters.len() && !(at(i) == '*' && at(i + 1) == '/') {
                i += 1;
            }
            i += 2;
        } else if c == '"' {
            i += 1;
            while i < letters.len() && at(i) != '"' {
                i += 1 + usize::from(at(i) == '\\');
            }
            i += 1;
            words.push(letters[begin..i.min(letters.len())].iter().collect());
        } else if c == '\'' {
            // A character ends within a few signs; a lifetime does not end with a quote.
            if at(i + 1) == '\\' {
                i += 3;
                while at(i) != '\'' {
                    i += 1;
                }
                i += 1;
            } else if at(i + 2) == '\'' {
                i += 3;
            } else {
                i += 1;
                while of_name(at(i)) {
                    i += 1;
                }
            }
        } else if of_name(c) {
            while of_name(at(i)) {
                i += 1;
            }
            let word: String = letters[begin..i].iter().collect();
            let hashes = (i..).take_while(|&j| at(j) == '#').count();
            if ["r", "br", "cr"].contains(&word.as_str()) && at(i + hashes) == '"' {
                let end: String = std::iter::once('"')
                    .chain(std::iter::repeat_n('#', hashes))
                    .collect();
                i += hashes + 1;
                while i < letters.len()
                    && !(0..=hashes).all(|k| end.chars().nth(k) == Some(at(i + k)))
                {
                    i += 1;
                }
                i += hashes + 1;
            } else {
                words.push(word);
            }
        } else if c == ':' && at(i + 1) == ':' {
            i += 2;
            words.push("::".into());
        } else {
            i += 1;
            if !c.is_whitespace() {
                words.push(c.into());
            }
        }
    }
    words
}

/// Index behind the bracket that closes the one at `open`.
pub fn behind(words: &[String], open: usize) -> usize {
    let mut depth = 0;
    for (i, word) in words.iter().enumerate().skip(open) {
        match word.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => {
                depth -= 1;
                if depth == 0 {
                    return i + 1;
                }
            }
            _ => {}
        }
    }
    words.len()
}

fn without_tests(words: &[String]) -> Vec<String> {
    let mut kept = Vec::new();
    let mark = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut i = 0;
    while i < words.len() {
        if !words[i..].iter().zip(mark).all(|(word, sign)| word == sign)
            || words.len() < i + mark.len()
        {
            kept.push(words[i].clone());
            i += 1;
            continue;
        }
        i += mark.len();
        while words.get(i).is_some_and(|word| word == "#") {
            i = behind(words, i + 1);
        }
        // The item up to its `;` or its closing brace.
        while i < words.len() && words[i] != ";" && words[i] != "{" {
            i = if ["(", "["].contains(&words[i].as_str()) {
                behind(words, i)
            } else {
                i + 1
            };
        }
        i = if words.get(i).is_some_and(|word| word == "{") {
            behind(words, i)
        } else {
            i + 1
        };
    }
    kept
}

/// Names of the public types of a file: `pub struct`, `enum`, `union`, `trait` and `type`.
pub fn public_types(words: &[String]) -> Vec<&str> {
    let kinds = ["struct", "enum", "union", "trait", "type"];
    let mut found = Vec::new();
    for (i, word) in words.iter().enumerate() {
        if word == "pub" && words.get(i + 2).is_some() && kinds.contains(&words[i + 1].as_str()) {
            found.push(words[i + 2].as_str());
        }
    }
    found
}
