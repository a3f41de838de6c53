//! Normal impulses of all wheels together, directly.
//!
//! Along the normals, with the velocities `v` (positive apart), stiffness `K` (anti-roll bars are its
//! only off-diagonal entries) and damping `C`, the impulses are `p = A − B v₁`, where
//! `B = dt² b K + dt q C` and `A = dt (F − (dt a K + (1 − q) C) v₀)`; see [`crate::vehicle::suspension`].
//! With `v₁ = v* + W p` that is `(W + B⁻¹) p = B⁻¹ A − v*`, solved here for the change of `p` that the
//! present velocities ask for. `B` falls apart into blocks of one wheel or the two of an axle.

#![expect(
    clippy::needless_range_loop,
    reason = "indices are the mathematics here"
)]

use super::{Contact, MOST_WHEELS, Problem, dense::Ldlt};
use crate::vehicle::suspension::{Piece, Scheme};

/// Speed with which a wheel beyond the end of its travel is pushed out of the ground, metres per second:
/// enough to be out soon, too little to throw the vehicle where a step appears under a wheel. Out of a
/// loose body that is lighter than the vehicle it is the less, the lighter that is: else the opposite push
/// would shoot the body away. There the spring lifts the wheel out.
const RECOVERY: f32 = 3.0;

pub(super) struct Normals {
    /// Mobilities between the contacts along their normals, 1/kg.
    mobility: [[f32; MOST_WHEELS]; MOST_WHEELS],
    /// Greatest mobility that the modes of each wheel show.
    total: [f32; MOST_WHEELS],
    start: [f32; MOST_WHEELS],
    piece: [Piece; MOST_WHEELS],
    pushing: [bool; MOST_WHEELS],
    /// `A`, and the diagonal and the off-diagonal entry of `B`.
    a: [f64; MOST_WHEELS],
    diagonal: [f64; MOST_WHEELS],
    off: [f64; MOST_WHEELS],
    /// Which contacts take part, and where each is in the system.
    rows: [usize; MOST_WHEELS],
    n: usize,
    ldlt: Ldlt,
    factored: bool,
}

impl Normals {
    pub fn new(problem: &Problem) -> Self {
        let mut normals = Self {
            mobility: [[0.0; MOST_WHEELS]; MOST_WHEELS],
            total: [0.0; MOST_WHEELS],
            start: [0.0; MOST_WHEELS],
            piece: [Piece::default(); MOST_WHEELS],
            pushing: [true; MOST_WHEELS],
            a: [0.0; MOST_WHEELS],
            diagonal: [0.0; MOST_WHEELS],
            off: [0.0; MOST_WHEELS],
            rows: [0; MOST_WHEELS],
            n: 0,
            ldlt: Ldlt::new(),
            factored: false,
        };
        let contacts = &problem.contacts;
        for (i, c) in contacts.iter().enumerate() {
            for (j, d) in contacts.iter().enumerate().take(i + 1) {
                let w = c.mobility(c.normal, d, d.normal, &problem.chassis, problem.grounds);
                normals.mobility[i][j] = w;
                normals.mobility[j][i] = w;
            }
            normals.start[i] = c.start_velocity(&problem.chassis).dot(c.normal);
        }
        for i in 0..contacts.len() {
            normals.total[i] = normals.mobility[i][..contacts.len()]
                .iter()
                .map(|w| w.abs())
                .sum();
        }
        normals
    }

    /// Compression that the present impulses lead to at the end of the tick, metres.
    fn expected(&self, i: usize, contact: &Contact, now: f32, problem: &Problem) -> f32 {
        let theta = problem.theta;
        let mean = (1.0 - theta) * self.start[i] + theta * now;
        contact.compression - problem.dt * mean / contact.cosine
    }

    /// Brings the impulses in line with the present velocities; returns the greatest change in parts
    /// of a wheel's impulse. `search` lets wheels change between hanging, springing and stopping.
    pub fn sweep(&mut self, problem: &mut Problem, search: bool) -> f32 {
        let count = problem.contacts.len();
        if count == 0 {
            return 0.0;
        }
        let mut now = [0.0f32; MOST_WHEELS];
        for (i, c) in problem.contacts.iter().enumerate() {
            now[i] = c.velocity(&problem.chassis, problem.grounds).dot(c.normal);
        }
        if search || !self.factored {
            self.linearise(problem, &now);
        }
        // A wheel that pulls is left out, and the rest solved again.
        let mut rhs = [0.0f64; MOST_WHEELS];
        let mut left_out = [0.0f32; MOST_WHEELS];
        for _ in 0..count {
            if !self.factored {
                self.factor(problem);
            }
            // Velocities without the impulses that are about to be taken off.
            for i in 0..count {
                left_out[i] = if self.pushing[i] {
                    0.0
                } else {
                    problem.contacts[i].push
                };
            }
            for (row, &i) in self.rows[..self.n].iter().enumerate() {
                let mut v = f64::from(now[i]);
                for j in 0..count {
                    v -= f64::from(self.mobility[i][j] * left_out[j]);
                }
                rhs[row] = self.wanted(i, problem.contacts, v);
            }
            self.ldlt.solve(&mut rhs);
            let mut worst = None;
            let mut least = -1.0e-9;
            for (row, &i) in self.rows[..self.n].iter().enumerate() {
                let p = f64::from(problem.contacts[i].push) + rhs[row];
                if p < least {
                    least = p;
                    worst = Some(i);
                }
            }
            let Some(worst) = worst else { break };
            self.pushing[worst] = false;
            self.factored = false;
        }
        if !self.factored {
            self.factor(problem);
            rhs = [0.0; MOST_WHEELS];
        }
        let mut delta = [0.0f32; MOST_WHEELS];
        for i in 0..count {
            if !self.pushing[i] {
                delta[i] = -problem.contacts[i].push;
            }
        }
        for (row, &i) in self.rows[..self.n].iter().enumerate() {
            delta[i] = rhs[row] as f32;
        }
        let total: f32 = problem.contacts.iter().map(|c| c.push).sum();
        let scale = count as f32 / (total + 1.0e-6);
        let mut change = 0.0f32;
        for (contact, delta) in problem.contacts.iter_mut().zip(delta) {
            if delta != 0.0 && delta.is_finite() {
                let push = (contact.push + delta).max(0.0);
                let impulse = contact.normal * (push - contact.push);
                contact.push = push;
                contact.push_both(impulse, &mut problem.chassis, problem.grounds);
                change = change.max(delta.abs() * scale);
            }
        }
        change
    }

    /// `B⁻¹ (A − B v − p)`: by how much a row misses its equation.
    fn wanted(&self, i: usize, contacts: &[Contact], v: f64) -> f64 {
        let own = self.a[i] - f64::from(contacts[i].push);
        let Some(j) = self.partner(i, contacts) else {
            return own / self.diagonal[i] - v;
        };
        let other = self.a[j] - f64::from(contacts[j].push);
        let det = self.diagonal[i] * self.diagonal[j] - self.off[i] * self.off[i];
        (own * self.diagonal[j] - other * self.off[i]) / det - v
    }

    fn partner(&self, i: usize, contacts: &[Contact]) -> Option<usize> {
        let (j, _) = contacts[i].bar?;
        (self.pushing[j] && self.pushing[i]).then_some(j)
    }

    /// Chooses each wheel's piece of the force law, and fills `A` and `B`.
    fn linearise(&mut self, problem: &Problem, now: &[f32; MOST_WHEELS]) {
        let dt = problem.dt;
        for (i, c) in problem.contacts.iter().enumerate() {
            let expected = self.expected(i, c, now[i], problem);
            // As stiff as brings the wheel to rest within the tick.
            let block = 2.0 / (dt * dt * self.total[i]);
            let ground = c.ground.map(|(index, _)| &problem.grounds[index]);
            let recovery = RECOVERY * dt * ground.map_or(1.0, |body| body.withstands);
            let piece = c
                .law
                .piece(c.compression, expected, now[i] < 0.0, block, recovery);
            // Above the ground a wheel pushes only if it gets there within the tick.
            let pushing = c.compression > 0.0 || expected > 0.0;
            if piece != self.piece[i] || pushing != self.pushing[i] || !self.factored {
                self.piece[i] = piece;
                self.pushing[i] = pushing;
                self.factored = false;
            }
        }
        if self.factored {
            return;
        }
        for (i, c) in problem.contacts.iter().enumerate() {
            let piece = &self.piece[i];
            let bar = match c.bar {
                Some((_, bar)) => bar,
                None => c.lone_bar,
            };
            let slope = 1.0 / (c.cosine * c.cosine);
            let (k, kc) = ((piece.stiffness + bar) * slope, piece.damping * slope);
            let scheme = Scheme::new(k, kc, self.total[i], dt, problem.theta);
            let mut force = piece.force + c.lone_bar * c.compression.max(0.0);
            let mut from_start = dt * scheme.a * k + (1.0 - scheme.q) * kc;
            from_start *= self.start[i];
            self.off[i] = 0.0;
            if let Some((j, bar)) = c.bar {
                let other = &problem.contacts[j];
                force += bar * (c.compression - other.compression);
                let cross = bar / (c.cosine * other.cosine);
                from_start -= dt * scheme.a * cross * self.start[j];
                self.off[i] = -f64::from(dt * dt * cross);
            }
            self.a[i] = f64::from(dt * (force / c.cosine - from_start));
            self.diagonal[i] = f64::from(dt * dt * scheme.b * k + dt * scheme.q * kc).max(1.0e-12);
            self.off[i] *= f64::from(scheme.b);
        }
        for (i, c) in problem.contacts.iter().enumerate() {
            if let Some((j, _)) = c.bar
                && i < j
            {
                // The smaller weight on both sides: the system stays symmetric and positive.
                let least = self.off[i].max(self.off[j]);
                (self.off[i], self.off[j]) = (least, least);
            }
        }
    }

    fn factor(&mut self, problem: &Problem) {
        self.n = 0;
        for i in 0..problem.contacts.len() {
            if self.pushing[i] {
                self.rows[self.n] = i;
                self.n += 1;
            }
        }
        let (rows, mobility) = (&self.rows, &self.mobility);
        let (diagonal, off) = (&self.diagonal, &self.off);
        let contacts = &problem.contacts;
        let pushing = &self.pushing;
        self.ldlt.factor(self.n, |r, s| {
            let (i, j) = (rows[r], rows[s]);
            let mut entry = f64::from(mobility[i][j]);
            let partner = contacts[i].bar.map(|(p, _)| p).filter(|p| pushing[*p]);
            match partner {
                Some(p) => {
                    let det = diagonal[i] * diagonal[p] - off[i] * off[i];
                    if i == j {
                        entry += diagonal[p] / det;
                    } else if j == p {
                        entry -= off[i] / det;
                    }
                }
                None if i == j => entry += 1.0 / diagonal[i],
                None => {}
            }
            entry
        });
        self.factored = true;
    }
}
