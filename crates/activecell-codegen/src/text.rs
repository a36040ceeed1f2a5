//! What the printers of all languages share.

use std::collections::BTreeSet;

/// A formula without the outermost brackets.
pub(crate) fn whole(formula: &str) -> &str {
    formula
        .strip_prefix('(')
        .and_then(|formula| formula.strip_suffix(')'))
        .filter(|formula| is_balanced(formula))
        .unwrap_or(formula)
}

/// Operands with an operator between them, in brackets; one alone stays as it is.
pub(crate) fn joined(operands: &[String], operator: &str) -> String {
    if let [operand] = operands { operand.clone() } else { format!("({})", operands.join(operator)) }
}

/// A long sum, each product in a line of its own.
pub(crate) fn lines(sum: &str, or: &str) -> String {
    if sum.len() < 90 { sum.into() } else { sum.replace(&format!("){or}("), &format!(")\n       {or}(")) }
}

fn is_balanced(formula: &str) -> bool {
    let mut depth = 0;
    formula.chars().all(|c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        depth >= 0
    })
}

/// A table in few lines: places whose entries are alike stand together; the most frequent entry is the default.
pub(crate) struct Cases {
    /// Each other entry and its places.
    pub(crate) entries: Vec<(u32, Vec<usize>)>,
    /// The entry of all other places.
    pub(crate) default: u32,
}

impl Cases {
    pub(crate) fn of(table: &[u32]) -> Self {
        let places = |entry: u32| (0..table.len()).filter(move |&place| table[place] == entry);
        let entries: BTreeSet<u32> = table.iter().copied().collect();
        let default = entries.iter().copied().max_by_key(|&entry| places(entry).count()).unwrap_or(0);
        let others = entries.into_iter().filter(|&entry| entry != default);
        Self { entries: others.map(|entry| (entry, places(entry).collect())).collect(), default }
    }
}
