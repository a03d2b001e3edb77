//! Work on pixels, on all processors.

use std::thread;

/// Maps each number below a count, and keeps the order.
pub fn map<T: Send>(count: usize, make: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let threads = thread::available_parallelism().map_or(1, Into::into);
    let share = count.div_ceil(threads).max(1);
    thread::scope(|scope| {
        let make = &make;
        let start =
            |first: usize| scope.spawn(move || (first..(first + share).min(count)).map(make).collect::<Vec<T>>());
        let started: Vec<_> = (0..count).step_by(share).map(start).collect();
        let joined =
            started.into_iter().map(|thread| thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        joined.flatten().collect()
    })
}
