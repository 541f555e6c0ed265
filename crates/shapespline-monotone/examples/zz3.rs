//! x
use shapespline_monotone::*;
struct Lcg(u64);
impl Lcg { fn next(&mut self) -> f64 { self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407); (self.0 >> 11) as f64 / (1u64 << 53) as f64 } }
fn main() {
    let mut rng = Lcg(3);
    let mut hist = [0usize; 50];
    for case in 0..3000 {
        let n = 3 + case % 40;
        let (mut x, mut y) = (vec![0.0], vec![0.0]);
        for k in 0..n {
            let turn = if case % 3 == 1 && rng.next() < 0.3 { -1.0 } else { 1.0 };
            let flat = case % 3 == 2 && rng.next() < 0.3;
            let rise = 10f64.powf(12.0 * (rng.next() - 0.5));
            x.push(x[k] + 10f64.powf(2.0 * (rng.next() - 0.5)));
            y.push(if flat { y[k] } else { y[k] + turn * rise });
        }
        for fairness in [Fairness::Bending, Fairness::Parametric] {
            if case == 245 { println!("CASE 245"); }
            let o = QuinticOptions { slopes: Slopes::Optimal, fairness, ..QuinticOptions::default() };
            if let Ok(q) = MonotoneQuintic::new(&x, &y, &o) { let d = q.diagnostics(); hist[d.iterations] += 1; if !d.converged { println!("case {case} {fairness:?} {d:?}"); } }
        }
    }
    println!("{hist:?}");
}
