// SPDX-License-Identifier: MIT OR Apache-2.0

//! Work on many items, shared between the threads of rayon's pool; on few, done where it stands.
//!
//! Every function takes `many`, the number of items from which on they are shared out (in parts of no fewer than an
//! eighth of that). Fewer never touch rayon, not even an iterator of its that would run on one thread: the first use of
//! one starts rayon's own pool. A process that is forked after that, as Python's `multiprocessing` forks on Linux,
//! inherits the pool without its threads and waits for them forever. So Python calls small work where it stands, and
//! enters a pool that knows its process for work on 8,192 items and more; `many` is never less than that.
//!
//! Results are in the order of the items and do not depend on the number of threads. What a loop costs is what a call
//! costs on few items.
//!
//! Without the feature `rayon` all work is done where it stands.

#![cfg_attr(
    not(feature = "rayon"),
    allow(unused_variables, dead_code, reason = "without threads nothing is ever many")
)]

use std::ops::Range;

#[cfg(feature = "rayon")]
use rayon::prelude::*;

/// What results are gathered in: a vector, an option or a result of one, a pair of vectors of the parts of pairs, or
/// nothing. A failure ends the work; of several that happen at the same time any may be told.
#[cfg(feature = "rayon")]
pub trait Gather<T: Send>: FromIterator<T> + FromParallelIterator<T> {}

#[cfg(feature = "rayon")]
impl<T: Send, C: FromIterator<T> + FromParallelIterator<T>> Gather<T> for C {}

/// What results are gathered in.
#[cfg(not(feature = "rayon"))]
pub trait Gather<T: Send>: FromIterator<T> {}

#[cfg(not(feature = "rayon"))]
impl<T: Send, C: FromIterator<T>> Gather<T> for C {}

/// `of(0), …, of(count − 1)`.
#[inline]
pub fn map<T: Send, C: Gather<T>>(count: usize, many: usize, of: impl Fn(usize) -> T + Sync) -> C {
    #[cfg(feature = "rayon")]
    if count >= many {
        return (0..count).into_par_iter().with_min_len(least(many)).map(&of).collect();
    }
    (0..count).map(of).collect()
}

/// The same, where each thread has a state of its own to work with, buffers say.
#[inline]
pub fn map_with<S, T: Send, C: Gather<T>>(
    count: usize,
    many: usize,
    state: impl Fn() -> S + Sync,
    of: impl Fn(&mut S, usize) -> T + Sync,
) -> C {
    #[cfg(feature = "rayon")]
    if count >= many {
        return (0..count)
            .into_par_iter()
            .with_min_len(least(many))
            .map_init(&state, &of)
            .collect();
    }
    let mut state = state();
    (0..count).map(|k| of(&mut state, k)).collect()
}

/// [`map`] over items that differ in the work they take: in parts of a few, however many there are, so that no thread is
/// left with much at the end.
pub fn map_uneven<T: Send, C: Gather<T>>(count: usize, of: impl Fn(usize) -> T + Sync) -> C {
    #[cfg(feature = "rayon")]
    return (0..count).into_par_iter().with_max_len(4).map(&of).collect();
    #[cfg(not(feature = "rayon"))]
    return (0..count).map(of).collect();
}

/// Runs work on so many threads of its own; where the system grants none, on those that it is called from.
pub fn on<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    #[cfg(feature = "rayon")]
    if let Ok(pool) = rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
        return pool.install(run);
    }
    run()
}

/// `of` every item and its index, in its place.
#[inline]
pub fn fill<T: Send>(items: &mut [T], many: usize, of: impl Fn(usize, &mut T) + Sync) {
    let of = |(i, item): (usize, &mut T)| of(i, item);
    #[cfg(feature = "rayon")]
    if items.len() >= many {
        items.par_iter_mut().with_min_len(least(many)).enumerate().for_each(of);
        return;
    }
    items.iter_mut().enumerate().for_each(of);
}

/// `of` the blocks `0..block`, `block..2·block`, … of `0..count`. The blocks are the same whatever the number of threads;
/// two whole ones are many.
#[inline]
pub fn blocks<T: Send, C: Gather<T>>(
    count: usize,
    block: usize,
    of: impl Fn(Range<usize>) -> T + Sync,
) -> C {
    let many = if count < 2 * block { usize::MAX } else { 0 };
    map(count.div_ceil(block), many, |k| of(k * block..count.min((k + 1) * block)))
}

/// What [`blocks`] give, joined from the first to the last; where they are few, `of(0..count)` at once.
#[inline]
pub fn fold<T: Send>(
    count: usize,
    block: usize,
    of: impl Fn(Range<usize>) -> T + Sync,
    join: impl Fn(T, T) -> T,
) -> T {
    if count < 2 * block {
        return of(0..count);
    }
    let all: Vec<T> = blocks(count, block, &of);
    all.into_iter().reduce(join).unwrap_or_else(|| of(0..0))
}

/// Slices that are cut at the same places: `&[T]`, `&mut [T]`, and pairs of what can be cut.
pub trait Cut: Send + Sized {
    /// How many items there are; of a pair, in the first.
    fn count(&self) -> usize;

    /// The first `at` items, and the others.
    #[must_use]
    fn cut(self, at: usize) -> (Self, Self);
}

impl<T: Sync> Cut for &[T] {
    #[inline]
    fn count(&self) -> usize {
        self.len()
    }

    #[inline]
    fn cut(self, at: usize) -> (Self, Self) {
        self.split_at(at.min(self.len()))
    }
}

impl<T: Send> Cut for &mut [T] {
    #[inline]
    fn count(&self) -> usize {
        self.len()
    }

    #[inline]
    fn cut(self, at: usize) -> (Self, Self) {
        let at = at.min(self.len());
        self.split_at_mut(at)
    }
}

impl<A: Cut, B: Cut> Cut for (A, B) {
    #[inline]
    fn count(&self) -> usize {
        self.0.count()
    }

    #[inline]
    fn cut(self, at: usize) -> (Self, Self) {
        let ((a, c), (b, d)) = (self.0.cut(at), self.1.cut(at));
        ((a, b), (c, d))
    }
}

/// `of` the parts of slices that have `size` items each (the last one the rest), with the index of the first item of each
/// and a state for each thread; shared out from `many` items on.
#[inline]
pub fn parts<P: Cut, S, T: Send, C: Gather<T>>(
    slices: P,
    size: usize,
    many: usize,
    state: impl Fn() -> S + Sync,
    of: impl Fn(&mut S, usize, P) -> T + Sync,
) -> C {
    let (count, mut rest) = (slices.count(), Some(slices));
    let all = (0..count).step_by(size).map_while(|start| {
        let (part, behind) = rest.take()?.cut(size);
        rest = Some(behind);
        Some((start, part))
    });
    #[cfg(feature = "rayon")]
    if count >= many {
        let all: Vec<(usize, P)> = all.collect();
        let of = |state: &mut S, (start, part)| of(state, start, part);
        return all.into_par_iter().map_init(&state, of).collect();
    }
    let mut state = state();
    all.map(|(start, part)| of(&mut state, start, part)).collect()
}

/// The results of two tasks, which run at the same time if they are `long`.
#[inline]
pub fn both<A: Send, B: Send>(
    long: bool,
    a: impl FnOnce() -> A + Send,
    b: impl FnOnce() -> B + Send,
) -> (A, B) {
    #[cfg(feature = "rayon")]
    if long {
        return rayon::join(a, b);
    }
    (a(), b())
}

/// Items that one thread takes at least.
fn least(many: usize) -> usize {
    (many / 8).max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn uneven_items_keep_their_order_on_any_number_of_threads() {
        for threads in [1, 3] {
            let all: Vec<usize> = on(threads, || map_uneven(100, |i| i));
            assert_eq!(all, (0..100).collect::<Vec<_>>());
        }
    }

    /// Few and many, with parts that divide the items and such that do not.
    #[test]
    fn every_way_does_what_a_loop_does() {
        let square = |i: usize| i * i;
        for count in [0, 1, 9, 10, 11, 100, 1003] {
            let expected: Vec<usize> = (0..count).map(square).collect();
            for many in [0, 10, 2000] {
                assert_eq!(map::<_, Vec<_>>(count, many, square), expected);
                let with = |seen: &mut usize, i: usize| {
                    *seen += 1;
                    i * i
                };
                assert_eq!(map_with::<_, _, Vec<_>>(count, many, || 0, with), expected);
                let mut out = vec![0; count];
                fill(&mut out, many, |i, out| *out = square(i));
                assert_eq!(out, expected);
                for size in [1, 7, 10] {
                    let numbers: Vec<usize> = (0..count).collect();
                    let mut out = vec![0; count];
                    let work =
                        |seen: &mut usize, start: usize, (x, out): (&[usize], &mut [usize])| {
                            assert!(x.len() == out.len() && x[0] == start);
                            *seen += x.len();
                            out.iter_mut().zip(x).for_each(|(out, x)| *out = x * x);
                            x.len()
                        };
                    let sizes: Vec<usize> = parts((&*numbers, &mut *out), size, many, || 0, work);
                    assert_eq!(out, expected);
                    assert_eq!(sizes.len(), count.div_ceil(size));
                    assert_eq!(sizes.iter().sum::<usize>(), count);
                }
            }
            for block in [1, 5, 50, 2000] {
                let sum = |range: Range<usize>| range.map(square).sum::<usize>();
                assert_eq!(fold(count, block, sum, |a, b| a + b), expected.iter().sum());
                let all: Vec<Vec<usize>> = blocks(count, block, |range| range.collect());
                assert_eq!(all.len(), count.div_ceil(block));
                assert_eq!(all.concat(), (0..count).collect::<Vec<_>>());
            }
        }
        assert_eq!(both(true, || 1, || 2), both(false, || 1, || 2));
    }

    #[test]
    fn failures_end_the_work() {
        for many in [0, 1000] {
            let small = |i: usize| if i == 60 { Err(i) } else { Ok(i) };
            assert_eq!(map::<_, Result<Vec<usize>, usize>>(100, many, small), Err(60));
            assert_eq!(map::<_, Option<()>>(100, many, |i| (i < 60).then_some(())), None);
            assert_eq!(map::<_, Option<()>>(60, many, |i| (i < 60).then_some(())), Some(()));
        }
    }

    /// Few items stay on the thread that asks.
    #[test]
    fn few_items_stay_on_this_thread() {
        let here = std::thread::current().id();
        let same = |_| std::thread::current().id() == here;
        assert!(map::<_, Vec<bool>>(99, 100, same).into_iter().all(|same| same));
        assert!(fold(99, 50, |_| std::thread::current().id() == here, |a, b| a && b));
    }
}
