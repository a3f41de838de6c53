//! Spins of wheels and engine, with the friction rows that tie them together.
//!
//! A row measures a relative speed `q · w` and answers with an impulse along `p` that wants to bring
//! it to 0, up to its limit. `q` and `p` differ only where torque is lost on the way (efficiency).
//! Rows that hold enter the inverse by one rank-one update each (Sherman and Morrison), with a
//! compliance of 1e-7 of their mobility, so that two rows that hold the same wheel share the load.
//! Rows at their limit are known impulses. In double precision.

#![expect(
    clippy::needless_range_loop,
    reason = "indices are the mathematics here"
)]

use super::MOST_WHEELS;

const N: usize = MOST_WHEELS + 1;
/// Wheels' brakes, differentials, clutch.
const MOST_ROWS: usize = 2 * MOST_WHEELS + 1;
/// Compliance of a row that holds, in parts of its mobility.
const SOFTNESS: f64 = 1.0e-7;

/// A friction row.
#[derive(Clone, Copy)]
pub(crate) struct Row {
    pub p: [f64; N],
    pub q: [f64; N],
    /// Greatest impulse, newton-metre-seconds.
    pub limit: f64,
    /// Whether it holds; else it gives `sign · limit`.
    holds: bool,
    sign: f64,
    switches: u8,
    compliance: f64,
}

impl Row {
    /// A brake on one shaft.
    pub fn brake(shaft: usize, limit: f64) -> Self {
        let mut axis = [0.0; N];
        axis[shaft] = 1.0;
        Self::new(axis, axis, limit)
    }

    pub fn new(p: [f64; N], q: [f64; N], limit: f64) -> Self {
        Self {
            p,
            q,
            limit,
            holds: true,
            sign: 0.0,
            switches: 0,
            compliance: 0.0,
        }
    }
}

/// All shafts of a vehicle in one tick: the wheels, then the engine.
pub(crate) struct Spin {
    n: usize,
    /// Speeds, rad/s, positive forward.
    pub w: [f64; N],
    pub start: [f64; N],
    inertia: [f64; N],
    /// Growth of resistance with speed, newton-metre-seconds; times `dt` from the start on.
    damping: [f64; N],
    /// Known impulses: engine, motors, newton-metre-seconds.
    pub known: [f64; N],
    /// Impulses of the tyres, about the axles.
    tires: [f64; N],
    inverse: [[f64; N]; N],
    rows: Vec<Row>,
}

impl Default for Spin {
    fn default() -> Self {
        Self {
            n: 0,
            w: [0.0; N],
            start: [0.0; N],
            inertia: [1.0; N],
            damping: [0.0; N],
            known: [0.0; N],
            tires: [0.0; N],
            inverse: [[0.0; N]; N],
            rows: Vec::with_capacity(MOST_ROWS),
        }
    }
}

impl Spin {
    /// Forgets everything; `n` shafts without anything that acts on them.
    pub fn clear(&mut self) {
        self.n = 0;
        self.rows.clear();
    }

    /// Adds a shaft and tells its number.
    pub fn shaft(&mut self, speed: f32, inertia: f32) -> usize {
        let i = self.n.min(N - 1);
        self.n = i + 1;
        self.start[i] = f64::from(speed);
        self.w[i] = f64::from(speed);
        self.inertia[i] = f64::from(inertia.max(1.0e-6));
        self.damping[i] = 0.0;
        self.known[i] = 0.0;
        self.tires[i] = 0.0;
        i
    }

    pub fn damp(&mut self, shaft: usize, damping: f32) {
        self.damping[shaft] = f64::from(damping);
    }

    /// Adds a row unless it can do nothing.
    pub fn row(&mut self, row: Row) -> Option<usize> {
        if !(row.limit > 0.0) || self.rows.len() >= MOST_ROWS {
            return None;
        }
        self.rows.push(row);
        Some(self.rows.len() - 1)
    }

    /// Guesses which rows hold.
    pub fn start(&mut self, dt: f32) {
        for damping in &mut self.damping[..self.n] {
            *damping *= f64::from(dt);
        }
        for row in &mut self.rows {
            let mut mobility = 0.0;
            let mut speed = 0.0;
            for i in 0..self.n {
                mobility += row.q[i] * row.p[i] / self.inertia[i];
                speed += row.q[i] * self.start[i];
            }
            row.compliance = SOFTNESS * mobility.max(1.0e-9);
            row.holds = speed.abs() <= row.limit * mobility;
            row.sign = if speed > 0.0 { -1.0 } else { 1.0 };
        }
        self.rebuild();
    }

    /// Speed of a wheel for each newton-second of its tyre along the wheel, in parts of its radius.
    pub fn mobility(&self, wheel: usize) -> f64 {
        self.inverse[wheel][wheel]
    }

    /// The impulse that a tyre begins with about its axle, newton-metre-seconds, against the spin.
    pub fn preload(&mut self, wheel: usize, impulse: f64) {
        self.tires[wheel] = impulse;
    }

    /// A change of a tyre's impulse about its axle, newton-metre-seconds, against the spin.
    pub fn push(&mut self, wheel: usize, impulse: f64) {
        self.tires[wheel] += impulse;
        for i in 0..self.n {
            self.w[i] -= self.inverse[i][wheel] * impulse;
        }
    }

    fn rebuild(&mut self) {
        let n = self.n;
        for i in 0..n {
            self.inverse[i][..n].fill(0.0);
            // The damping acts on the speed to come.
            self.inverse[i][i] = 1.0 / (self.inertia[i] + self.damping[i]);
        }
        let mut momentum = [0.0; N];
        for i in 0..n {
            momentum[i] = self.start[i] * self.inertia[i] + self.known[i] - self.tires[i];
        }
        for row in &self.rows {
            if !row.holds {
                for (m, p) in momentum.iter_mut().zip(&row.p) {
                    *m += p * row.sign * row.limit;
                }
                continue;
            }
            let mut ap = [0.0; N];
            let mut qa = [0.0; N];
            for i in 0..n {
                for j in 0..n {
                    ap[i] += self.inverse[i][j] * row.p[j];
                    qa[j] += row.q[i] * self.inverse[i][j];
                }
            }
            let mut total = row.compliance;
            for i in 0..n {
                total += row.q[i] * ap[i];
            }
            if total > 0.0 {
                for i in 0..n {
                    let scaled = ap[i] / total;
                    if scaled != 0.0 {
                        for j in 0..n {
                            self.inverse[i][j] -= scaled * qa[j];
                        }
                    }
                }
            }
        }
        for i in 0..n {
            self.w[i] = 0.0;
            for j in 0..n {
                self.w[i] += self.inverse[i][j] * momentum[j];
            }
        }
    }

    fn measured(&self, row: &Row) -> f64 {
        (0..self.n).map(|i| row.q[i] * self.w[i]).sum()
    }

    /// Impulse of a row, newton-metre-seconds.
    pub fn impulse(&self, index: usize) -> f64 {
        let row = &self.rows[index];
        if row.holds {
            -self.measured(row) / row.compliance
        } else {
            row.sign * row.limit
        }
    }

    /// Lets rows change between holding and sliding; tells whether any did.
    pub fn switch(&mut self, allowed: bool) -> bool {
        if !allowed {
            return false;
        }
        let mut any = false;
        for i in 0..self.rows.len() {
            let speed = self.measured(&self.rows[i]);
            let row = &mut self.rows[i];
            // One that goes back and forth stays at its limit.
            if row.switches > 4 {
                continue;
            }
            if row.holds {
                let impulse = -speed / row.compliance;
                if impulse.abs() > row.limit * (1.0 + 1.0e-6) {
                    row.holds = false;
                    row.sign = impulse.signum();
                    row.switches += 1;
                    any = true;
                }
            } else if speed * row.sign > 0.0 {
                row.holds = true;
                row.switches += 1;
                any = true;
            }
        }
        if any {
            self.rebuild();
        }
        any
    }
}
