// SPDX-License-Identifier: MIT OR Apache-2.0

//! Collections of rows of different lengths, and work on all rows at once.

use std::ops::Range;

use shapespline_polynomial::parallel;

use crate::InputError;

/// Most threads that are made where a caller asks for more than the machine has processors.
const MAX_THREADS: usize = 256;

/// Rows of different lengths in one array: row `k` is `values[offsets[k]..offsets[k + 1]]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ragged<'a, T> {
    values: &'a [T],
    offsets: &'a [usize],
}

impl<'a, T: Sync> Ragged<'a, T> {
    /// The rows that offsets cut out of values.
    ///
    /// # Errors
    /// Offsets that do not begin with 0, fall, or do not end with the number of values.
    pub fn new(values: &'a [T], offsets: &'a [usize]) -> Result<Self, InputError> {
        let wrong = |index: usize, allowed| InputError::OutOfRange {
            argument: "offsets",
            index,
            value: offsets.get(index).map_or(f64::NAN, |&x| x as f64),
            allowed,
        };
        if offsets.first() != Some(&0) {
            return Err(wrong(0, "0, where the first row begins"));
        }
        if let Some(i) = offsets.windows(2).position(|w| w[1] < w[0]) {
            return Err(wrong(i + 1, "no less than the offset before it"));
        }
        let (last, expected) = (offsets.len() - 1, offsets[offsets.len() - 1]);
        if expected != values.len() {
            return Err(wrong(last, "the number of values, where the last row ends"));
        }
        Ok(Self { values, offsets })
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.offsets.len() - 1
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where row `k` lies among the values.
    #[must_use]
    pub fn range(&self, k: usize) -> Range<usize> {
        self.offsets[k]..self.offsets[k + 1]
    }

    /// Row `k`.
    #[must_use]
    pub fn row(&self, k: usize) -> &'a [T] {
        &self.values[self.range(k)]
    }

    /// Calls `work` with every row and its index, in parallel; results in the order of the rows.
    ///
    /// `threads`: `None` takes rayon's pool as it is (the caller's, else the global one), which also
    /// does the work where the system grants no threads of its own. No more are made than there are
    /// rows.
    ///
    /// # Errors
    /// Zero threads.
    pub fn map<R: Send>(
        &self,
        threads: Option<usize>,
        work: impl Fn(usize, &'a [T]) -> R + Sync,
    ) -> Result<Vec<R>, InputError> {
        let run = || parallel::map_uneven(self.len(), |k| work(k, self.row(k)));
        let Some(count) = threads else { return Ok(run()) };
        if count == 0 {
            let (argument, value) = ("threads", 0.0);
            return Err(InputError::Scalar { argument, value, allowed: "at least 1" });
        }
        let processors = std::thread::available_parallelism().map_or(1, usize::from);
        let count = count.min(self.len().max(1)).min(processors.max(MAX_THREADS));
        Ok(parallel::on(count, run))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_mapped_in_order_on_any_number_of_threads() {
        let values: Vec<usize> = (0..100).collect();
        let offsets = [0, 3, 3, 50, 100];
        let rows = Ragged::new(&values, &offsets).unwrap();
        for threads in [None, Some(1), Some(3), Some(usize::MAX)] {
            let sums = rows.map(threads, |k, row| (k, row.iter().sum::<usize>())).unwrap();
            assert_eq!(sums, [(0, 3), (1, 0), (2, 1222), (3, 3725)]);
        }
        assert!(Ragged::new(&values[..0], &[0]).unwrap().is_empty());
        assert!(rows.map(Some(0), |_, _| ()).unwrap_err().to_string().contains("threads"));
    }

    #[test]
    fn offsets_that_do_not_fit_are_refused() {
        let refused = |offsets: &[usize]| Ragged::new(&[0; 5], offsets).unwrap_err().to_string();
        assert!(refused(&[]).contains("offsets[0]"));
        assert!(refused(&[1, 5]).contains("offsets[0] must be 0"));
        assert!(refused(&[0, 4, 3, 5]).contains("offsets[2]"));
        assert!(refused(&[0, 4]).contains("offsets[1]"));
    }
}
