//! x
mod common;
use common::*;
#[test]
fn look() {
    for penalty in ["1e4", "1e5", "1e6", "1e7"] {
        let set = [
            ("contact.tip.enforcement.penalty", penalty),
            ("solver.newton.force_tol", "1e-6"),
        ];
        let run = run(&mut example("paper_brick_arbitrary_3d", &set));
        println!("{penalty} {:?}", run.error.as_ref().map(|e| e.to_string()));
        let mut its = vec![];
        for n in 1..=run.frames.len() {
            let r = run.residuals(n);
            its.push(r.len() - 1);
            for w in r.windows(2) {
                let c = w[1] / (w[0] * w[0]);
                if w[1] > 1e-11 && c > 100.0 {
                    println!("  {n} const {c:.0} {r:?}");
                }
            }
        }
        println!("{its:?}");
    }
}
