// SPDX-License-Identifier: MIT OR Apache-2.0

//! Long work: without the interpreter lock, on a thread pool that survives `fork`, and with Ctrl-C.

use std::{
    cell::OnceCell,
    ops::{ControlFlow, Range},
    process,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc,
    },
    time::{Duration, Instant},
};

use arc_swap::ArcSwapOption;
use pyo3::{exceptions::PyKeyboardInterrupt, prelude::*};
use rayon::{ThreadPool, ThreadPoolBuilder};

/// From so many items on, the crates below work in parallel.
pub(crate) const PARALLEL: usize = 8192;

/// How often a long search asks whether Ctrl-C was pressed.
const SIGNAL_POLL_INTERVAL: Duration = Duration::from_millis(50);

/// Threads, and the process that has them.
struct Pool {
    process: u32,
    threads: ThreadPool,
}

/// The pool of this process, or `None` where the system grants no threads.
///
/// A forked child inherits a pool without its threads, and would wait for them for ever (Python forks
/// in `multiprocessing` on Linux), so the pool remembers its process, and a child makes a new one. It
/// inherits locks as they are, too, held by threads that it does not have: so there is none here. Two
/// threads may make a pool at the same time; the first to publish its own wins.
fn pool() -> Option<Arc<Pool>> {
    static POOL: ArcSwapOption<Pool> = ArcSwapOption::const_empty();
    let process = process::id();
    let ours = |pool: &Arc<Pool>| pool.process == process;
    let found = POOL.load_full();
    if let Some(pool) = found.as_ref().filter(|pool| ours(pool)) {
        return Some(Arc::clone(pool));
    }
    let threads = ThreadPoolBuilder::new().build().ok()?;
    let made = Some(Arc::new(Pool { process, threads }));
    let published = POOL.compare_and_swap(&found, made.clone());
    let winner = published.as_ref().filter(|pool| ours(pool)).cloned();
    // A pool of the parent is never dropped: that would wake its threads, which live over there.
    std::mem::forget((found, published));
    winner.or(made)
}

/// Runs work in a pool of this thread alone, for systems that grant no other (a limit on processes or
/// memory): outside any pool the crates below would ask for rayon's global one, which panics there.
fn without_threads<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    thread_local! {
        static INLINE: OnceCell<Option<ThreadPool>> = const { OnceCell::new() };
    }
    let one = || ThreadPoolBuilder::new().num_threads(1).use_current_thread().build().ok();
    INLINE.with(|pool| match pool.get_or_init(one) {
        Some(pool) => pool.install(work),
        None => work(),
    })
}

/// Runs work on `size` items while other Python threads go on.
pub(crate) fn without_gil<T: Send>(
    py: Python<'_>,
    size: usize,
    work: impl FnOnce() -> T + Send,
) -> T {
    if size < PARALLEL {
        return py.detach(work);
    }
    py.detach(|| match pool() {
        Some(pool) => pool.threads.install(work),
        None => without_threads(work),
    })
}

/// Called regularly from any thread; returns `Break` after Ctrl-C.
pub(crate) type GoOn<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

fn go_on(stop: &AtomicBool) -> ControlFlow<()> {
    if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Runs work on `size` items that asks at least every second whether to go on; Ctrl-C ends it with
/// `KeyboardInterrupt`, whatever it has made.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    size: usize,
    work: impl FnOnce(GoOn<'_>) -> T + Send,
) -> PyResult<T> {
    let done = py.detach(|| {
        if size < PARALLEL {
            return inline(work);
        }
        match pool() {
            Some(pool) => interruptible_in_pool(&pool.threads, work),
            None => without_threads(|| inline(work)),
        }
    });
    // What came in while the last step ran.
    py.check_signals()?;
    done
}

/// What is raised where work broke off.
pub(crate) fn interrupted() -> PyErr {
    PyKeyboardInterrupt::new_err(())
}

/// Items that are worked on between two questions whether Ctrl-C was pressed: milliseconds.
const PART: usize = 1 << 17;

/// What a function makes of `size` items, part by part where there are many; Ctrl-C ends it with
/// `KeyboardInterrupt`.
pub(crate) fn in_parts<E: Send>(
    py: Python<'_>,
    size: usize,
    of: impl Fn(Range<usize>) -> Result<Vec<f64>, E> + Send + Sync,
) -> PyResult<Result<Vec<f64>, E>> {
    if size <= PART {
        return Ok(without_gil(py, size, || of(0..size)));
    }
    interruptible(py, size, |go_on| {
        let mut all = Vec::with_capacity(size);
        for part in parts(size).take_while(|_| go_on().is_continue()) {
            all.append(&mut of(part)?);
        }
        Ok(all)
    })
}

/// The parts of so many items; one even of none.
pub(crate) fn parts(size: usize) -> impl Iterator<Item = Range<usize>> {
    (0..size.max(1)).step_by(PART).map(move |start| start..size.min(start + PART))
}

/// The work runs on this thread, and asks for signals itself.
fn inline<T>(work: impl FnOnce(GoOn<'_>) -> T) -> PyResult<T> {
    let signals = Mutex::new(Signals { polled: Instant::now(), interrupt: None });
    let poll = || signals.lock().unwrap_or_else(PoisonError::into_inner).poll();
    let result = work(&poll);
    let signals = signals.into_inner().unwrap_or_else(PoisonError::into_inner);
    signals.interrupt.map_or(Ok(result), Err)
}

/// Signals that a thread asks for now and then.
struct Signals {
    polled: Instant,
    interrupt: Option<PyErr>,
}

impl Signals {
    fn poll(&mut self) -> ControlFlow<()> {
        if self.interrupt.is_none() && self.polled.elapsed() >= SIGNAL_POLL_INTERVAL {
            self.interrupt = Python::attach(|py| py.check_signals()).err();
            self.polled = Instant::now();
        }
        if self.interrupt.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    }
}

/// The work runs in the pool; this thread, which may be the one that signals reach, watches.
fn interruptible_in_pool<T: Send>(
    pool: &ThreadPool,
    work: impl FnOnce(GoOn<'_>) -> T + Send,
) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    let (sender, receiver) = mpsc::channel();
    let mut interrupt = None;
    let mut result = None;
    pool.in_place_scope(|scope| {
        scope.spawn(|_| {
            result = Some(work(&|| go_on(&stop)));
            // The watcher may have gone: then nobody waits for this.
            let _ = sender.send(());
        });
        while receiver.recv_timeout(SIGNAL_POLL_INTERVAL) == Err(mpsc::RecvTimeoutError::Timeout) {
            if let Err(error) = Python::attach(|py| py.check_signals()) {
                stop.store(true, Ordering::Relaxed);
                interrupt = Some(error);
                break;
            }
        }
    });
    match (interrupt, result) {
        (Some(error), _) => Err(error),
        (None, Some(result)) => Ok(result),
        // A panic in the work has been handed on by the scope already.
        (None, None) => Err(pyo3::exceptions::PyRuntimeError::new_err("the work gave no result")),
    }
}

/// Runs many short searches, none of which uses threads itself: on this thread, which begins at once and
/// asks for signals whenever its search asks whether to go on, and on those of the pool as they wake up.
pub(crate) fn interruptible_each<T: Send>(
    py: Python<'_>,
    count: usize,
    search: impl Fn(usize, GoOn<'_>) -> T + Sync,
) -> PyResult<Vec<T>> {
    let (stop, next) = (AtomicBool::new(false), AtomicUsize::new(0));
    let take = |go_on: GoOn<'_>| {
        let mut done = Vec::new();
        while go_on().is_continue() {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= count {
                break;
            }
            done.push((k, search(k, go_on)));
        }
        done
    };
    let signals = Mutex::new(Signals { polled: Instant::now(), interrupt: None });
    let poll_here = || {
        let answer = signals.lock().unwrap_or_else(PoisonError::into_inner).poll();
        if answer.is_break() {
            stop.store(true, Ordering::Relaxed);
        }
        answer
    };
    let all = py.detach(|| {
        let Some(pool) = pool() else { return take(&poll_here) };
        let others = Mutex::new(Vec::new());
        let (sender, receiver) = mpsc::channel::<()>();
        let mut all = pool.threads.in_place_scope(|scope| {
            for _ in 1..pool.threads.current_num_threads().min(count) {
                let sender = sender.clone();
                let (take, others, stop) = (&take, &others, &stop);
                scope.spawn(move |_| {
                    let done = take(&|| go_on(stop));
                    others.lock().unwrap_or_else(PoisonError::into_inner).extend(done);
                    drop(sender);
                });
            }
            drop(sender);
            let done = take(&poll_here);
            // The others may each have one long search left: signals are asked for until all are done.
            while receiver.recv_timeout(SIGNAL_POLL_INTERVAL)
                == Err(mpsc::RecvTimeoutError::Timeout)
            {
                if poll_here().is_break() {
                    break;
                }
            }
            done
        });
        all.extend(others.into_inner().unwrap_or_else(PoisonError::into_inner));
        all
    });
    if let Some(error) = signals.into_inner().unwrap_or_else(PoisonError::into_inner).interrupt {
        return Err(error);
    }
    py.check_signals()?;
    let mut in_order: Vec<Option<T>> = (0..count).map(|_| None).collect();
    for (k, found) in all {
        in_order[k] = Some(found);
    }
    Ok(in_order.into_iter().flatten().collect())
}
