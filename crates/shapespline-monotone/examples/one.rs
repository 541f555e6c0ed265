use shapespline_monotone::*;
fn main() {
    let mut state = 7u64;
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let n: usize = std::env::args().nth(1).and_then(|a| a.parse().ok()).unwrap_or(20);
    let sets: usize = std::env::args().nth(2).and_then(|a| a.parse().ok()).unwrap_or(300);
    let kind: usize = std::env::args().nth(3).and_then(|a| a.parse().ok()).unwrap_or(0);
    let (mut best, mut steps) = (0.0, 0);
    for _ in 0..sets {
        let (mut x, mut y) = (vec![0.0], vec![0.0]);
        for k in 1..n {
            let (a, b) = (next(), next());
            let e = |u: f64| -(1.0 - u).ln();
            let (dx, dy) = match kind {
                0 => (0.1 + a, b),
                1 => (e(a), e(b)),
                2 => (a.max(1e-9), b),
                3 => (1.0, 10f64.powf(5.0 * (b - 0.5))),
                _ => (10f64.powf(2.0 * a - 1.0), 10f64.powf(12.0 * b - 6.0)),
            };
            x.push(x[k - 1] + dx);
            y.push(y[k - 1] + dy);
        }
        let mut least = f64::INFINITY;
        for _ in 0..if sets > 400 { 5 } else { 1 } {
            let t = std::time::Instant::now();
            let f = MonotoneQuintic::new(&x, &y, &QuinticOptions::default()).unwrap();
            least = least.min(t.elapsed().as_secs_f64());
            steps += f.diagnostics().iterations;
        }
        best += least;
    }
    println!("{:.2} us, {} iter", 1e6 * best / sets as f64, steps);
}
