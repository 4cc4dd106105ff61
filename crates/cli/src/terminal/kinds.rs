//! Messages of one kind: those that differ in numbers, quoted words and names of tails, flights and types alone.

/// Words before a name that differs from case to case.
const BEFORE_NAMES: [&str; 3] = ["tail ", "flight ", "type "];

/// A message without what differs from case to case.
pub(crate) fn kind_of(message: &str) -> String {
    let named = without_names(message);
    let message = named.as_str();
    let mut kind = String::with_capacity(message.len());
    let mut quoted = false;
    for letter in message.chars() {
        if letter == '"' {
            quoted = !quoted;
        }
        let is_blank = quoted || letter.is_ascii_digit();
        match (is_blank, kind.ends_with('#')) {
            (true, true) => {}
            (true, false) => kind.push('#'),
            (false, _) => kind.push(letter),
        }
    }
    kind
}

/// A message without the names of tails, flights and types.
fn without_names(message: &str) -> String {
    let mut words: Vec<&str> = Vec::new();
    for word in message.split_inclusive(' ') {
        let is_name = words.last().is_some_and(|before| BEFORE_NAMES.contains(before));
        words.push(if is_name { "# " } else { word });
    }
    words.concat()
}

/// What was told of each kind.
#[derive(Debug)]
pub(crate) struct Told {
    /// So many of a kind are told, the others counted.
    most: usize,
    kinds: Vec<Kind>,
}

#[derive(Debug)]
struct Kind {
    name: String,
    first: String,
    count: usize,
}

impl Told {
    /// Nothing yet.
    pub(crate) const fn new(most: usize) -> Self {
        Self { most, kinds: Vec::new() }
    }

    /// Counts a message, and decides whether it is told.
    pub(crate) fn is_told(&mut self, message: &str) -> bool {
        let name = kind_of(message);
        if let Some(kind) = self.kinds.iter_mut().find(|kind| kind.name == name) {
            kind.count += 1;
            return kind.count <= self.most;
        }
        self.kinds.push(Kind { name, first: message.to_owned(), count: 1 });
        self.most > 0
    }

    /// How many of this message's kind there were.
    pub(crate) fn count(&self, message: &str) -> usize {
        let name = kind_of(message);
        self.kinds.iter().find(|kind| kind.name == name).map_or(0, |kind| kind.count)
    }

    /// The first message of each kind of which not all were told, and how many were not.
    pub(crate) fn untold(&self) -> impl Iterator<Item = (&str, usize)> {
        self.kinds.iter().filter_map(|kind| {
            let more = kind.count.saturating_sub(self.most);
            (more > 0).then_some((kind.first.as_str(), more))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_names_make_no_kind() {
        assert_eq!(kind_of("found \"abc\", line 12"), kind_of("found \"x\", line 7"));
        assert_ne!(kind_of("12 rows lack a number"), kind_of("12 rows lack a mass"));
        let learnt =
            |tail: &str| kind_of(&format!("tail {tail} flight AB of 2019 is in the ledger"));
        assert_eq!(learnt("D-AAQ"), learnt("D-ACT"));
        assert_ne!(kind_of("tail D-AAQ has events"), kind_of("tail D-AAQ has no flight"));
    }

    #[test]
    fn thirty_of_a_kind_are_one_and_a_count() {
        let mut told = Told::new(1);
        let lines: Vec<usize> =
            (0..30).filter(|row| told.is_told(&format!("{row} rows lack a number"))).collect();
        assert_eq!(lines, [0]);
        assert!(told.is_told("another kind"));
        assert_eq!(told.untold().collect::<Vec<_>>(), [("0 rows lack a number", 29)]);
    }
}
