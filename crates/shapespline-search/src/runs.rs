//! Connected runs of nodes under tension.

/// Tensions whose sums differ by less than this, relatively, count as equal: what is symmetric in the
/// data is treated alike, whatever the rounding.
const TIE: f64 = 1e-9;

/// A maximal run of neighbouring nodes with positive tension.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Run {
    /// First node.
    pub(crate) first: usize,
    /// Number of nodes; a run of closed data may go on beyond the last node.
    pub(crate) length: usize,
    /// Sum of its tensions.
    pub(crate) total: f64,
}

impl Run {
    /// The nodes of the run in data of `n` nodes.
    pub(crate) fn nodes(&self, n: usize) -> impl Iterator<Item = usize> + use<> {
        let (first, length) = (self.first, self.length);
        (first..first + length).map(move |i| i % n)
    }

    /// Whether this run has as much tension as another.
    pub(crate) fn ties(&self, other: &Self) -> bool {
        (self.total - other.total).abs() <= TIE * self.total
    }
}

/// The runs in ascending order; in closed data a run may lead over the last node to the first.
pub(crate) fn runs(tension: &[f64], closed: bool) -> Vec<Run> {
    let mut found: Vec<Run> = Vec::new();
    for (i, &t) in tension.iter().enumerate() {
        if t > 0.0 {
            match found.last_mut() {
                Some(run) if run.first + run.length == i => {
                    run.length += 1;
                    run.total += t;
                }
                _ => found.push(Run { first: i, length: 1, total: t }),
            }
        }
    }
    let n = tension.len();
    if closed && found.len() > 1 && found[0].first == 0 {
        let wraps = &found[found.len() - 1];
        if wraps.first + wraps.length == n {
            let head = found.remove(0);
            if let Some(tail) = found.last_mut() {
                tail.length += head.length;
                tail.total += head.total;
            }
        }
    }
    found
}
