//! Long work: without the interpreter lock, on a thread pool that survives `fork`, and with Ctrl-C.

use std::{
    ops::ControlFlow,
    process,
    sync::{
        Arc, Mutex, PoisonError,
        atomic::{AtomicBool, AtomicUsize, Ordering},
        mpsc,
    },
    time::{Duration, Instant},
};

use pyo3::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

/// From so many items on, the crates below work in parallel.
pub(crate) const PARALLEL: usize = 8192;

/// How often a long search asks whether Ctrl-C was pressed.
const PATIENCE: Duration = Duration::from_millis(50);

/// The pool of this process.
///
/// A forked child inherits a pool without its threads, and would wait for them for ever (Python forks
/// in `multiprocessing` on Linux): so the pool remembers its process, and a child makes a new one.
fn pool() -> Option<Arc<ThreadPool>> {
    static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);
    let mut pool = POOL.lock().unwrap_or_else(PoisonError::into_inner);
    match &*pool {
        Some((process, threads)) if *process == process::id() => Some(Arc::clone(threads)),
        _ => {
            let threads = Arc::new(ThreadPoolBuilder::new().build().ok()?);
            if let Some((_, parents)) = pool.replace((process::id(), Arc::clone(&threads))) {
                // Its threads live in the parent process.
                std::mem::forget(parents);
            }
            Some(threads)
        }
    }
}

/// Runs work on `size` items while other Python threads go on.
pub(crate) fn detached<T: Send>(py: Python<'_>, size: usize, work: impl FnOnce() -> T + Send) -> T {
    if size < PARALLEL {
        return py.detach(work);
    }
    py.detach(|| match pool() {
        Some(pool) => pool.install(work),
        None => work(),
    })
}

/// A search's question whether to go on.
pub(crate) type Monitor<'a> = &'a mut (dyn FnMut() -> ControlFlow<()> + Send);

/// The same question of many searches at once, asked from any thread.
pub(crate) type GoOn<'a> = &'a (dyn Fn() -> ControlFlow<()> + Sync);

/// Whether Ctrl-C was not pressed.
fn go_on(stop: &AtomicBool) -> ControlFlow<()> {
    if stop.load(Ordering::Relaxed) { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
}

/// Runs a search over `size` items that asks a monitor at each step whether to go on; Ctrl-C ends it
/// with `KeyboardInterrupt`.
pub(crate) fn interruptible<T: Send>(
    py: Python<'_>,
    size: usize,
    search: impl FnOnce(Monitor<'_>) -> T + Send,
) -> PyResult<T> {
    let done = if size < PARALLEL {
        py.detach(|| alone(search))
    } else {
        py.detach(|| match pool() {
            Some(pool) => watched(&pool, |stop| search(&mut || go_on(stop))),
            None => alone(search),
        })
    };
    // What came in while the last step ran.
    py.check_signals()?;
    done
}

/// Runs many searches at once, which ask the same question (of a function, for any thread may ask).
pub(crate) fn interruptible_many<T: Send>(
    py: Python<'_>,
    searches: impl FnOnce(GoOn<'_>) -> T + Send,
) -> PyResult<T> {
    let done = py.detach(|| match pool() {
        Some(pool) => watched(&pool, |stop| searches(&|| go_on(stop))),
        None => Ok(searches(&|| ControlFlow::Continue(()))),
    });
    py.check_signals()?;
    done
}

/// Runs many short searches, none of which uses threads itself: on this thread, which begins at once and
/// looks for Ctrl-C between two of them, and on those of the pool as they wake up.
pub(crate) fn interruptible_each<T: Send>(
    py: Python<'_>,
    count: usize,
    search: impl Fn(usize, GoOn<'_>) -> T + Sync,
) -> PyResult<Vec<T>> {
    let (stop, next) = (AtomicBool::new(false), AtomicUsize::new(0));
    let take = |watch: &mut dyn FnMut()| {
        let mut done = Vec::new();
        loop {
            let k = next.fetch_add(1, Ordering::Relaxed);
            if k >= count {
                return done;
            }
            done.push((k, search(k, &|| go_on(&stop))));
            watch();
        }
    };
    let mut interrupt = None;
    let all = py.detach(|| {
        let mut asked = Instant::now();
        let mut here = || {
            take(&mut || {
                if asked.elapsed() >= PATIENCE {
                    if let Err(error) = Python::attach(|py| py.check_signals()) {
                        stop.store(true, Ordering::Relaxed);
                        interrupt = Some(error);
                    }
                    asked = Instant::now();
                }
            })
        };
        let Some(pool) = pool() else { return here() };
        let others = Mutex::new(Vec::new());
        let mut all = pool.in_place_scope(|scope| {
            for _ in 1..pool.current_num_threads().min(count) {
                scope.spawn(|_| {
                    let done = take(&mut || {});
                    others.lock().unwrap_or_else(PoisonError::into_inner).extend(done);
                });
            }
            here()
        });
        all.extend(others.into_inner().unwrap_or_else(PoisonError::into_inner));
        all
    });
    if let Some(error) = interrupt {
        return Err(error);
    }
    py.check_signals()?;
    let mut in_order: Vec<Option<T>> = (0..count).map(|_| None).collect();
    for (k, found) in all {
        in_order[k] = Some(found);
    }
    Ok(in_order.into_iter().flatten().collect())
}

/// The search runs on this thread, and asks for signals itself.
fn alone<T>(search: impl FnOnce(Monitor<'_>) -> T) -> PyResult<T> {
    let mut asked = Instant::now();
    let mut interrupt = None;
    let result = search(&mut || {
        if asked.elapsed() >= PATIENCE {
            interrupt = Python::attach(|py| py.check_signals()).err();
            asked = Instant::now();
        }
        if interrupt.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    interrupt.map_or(Ok(result), Err)
}

/// The search runs in the pool; this thread, which may be the one that signals reach, watches.
fn watched<T: Send>(
    pool: &ThreadPool,
    search: impl FnOnce(&AtomicBool) -> T + Send,
) -> PyResult<T> {
    let stop = AtomicBool::new(false);
    let (sender, receiver) = mpsc::channel();
    let mut interrupt = None;
    let mut result = None;
    pool.in_place_scope(|scope| {
        scope.spawn(|_| {
            result = Some(search(&stop));
            // The watcher may have gone: then nobody waits for this.
            let _ = sender.send(());
        });
        while receiver.recv_timeout(PATIENCE) == Err(mpsc::RecvTimeoutError::Timeout) {
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
        // A panic in the search has been handed on by the scope already.
        (None, None) => Err(pyo3::exceptions::PyRuntimeError::new_err("the search gave no result")),
    }
}
