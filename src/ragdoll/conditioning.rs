//! Evening out masses and inertias along the tree, so that the solver converges.
//!
//! Bones far lighter than what hangs on them, or than what they hang on, are what a solver that goes
//! joint by joint cannot settle. Down each chain the ratio of neighbouring masses is brought within
//! 0.8 to 1.2, the whole keeps its mass, and no bone turns more easily than what hangs on it.

use bevy::{math::ops, prelude::*};

const LEAST: f32 = 0.8;
const MOST: f32 = 1.2;

/// Mass and principal moments of inertia of each bone; parents come before their children. `part` is
/// how far to go, `0..=1`.
pub(super) fn condition(
    masses: &mut [f32],
    inertias: &mut [Vec3],
    parents: &[Option<usize>],
    part: f32,
) {
    if !(part > 0.0) || masses.is_empty() {
        return;
    }
    let total: f32 = masses.iter().sum();
    let mut ratios = vec![1.0; masses.len()];
    for i in 0..masses.len() {
        if let Some(p) = parents[i] {
            ratios[i] = ratios[p] * (masses[i] / masses[p]).clamp(LEAST, MOST);
        }
    }
    let scale = total / ratios.iter().sum::<f32>();
    // Half way is the geometric mean.
    let between = |a: f32, b: f32| a * ops::powf(b / a, part);
    let mut even: Vec<f32> = (masses.iter().zip(&ratios))
        .map(|(m, r)| between(*m, r * scale))
        .collect();
    let sum = total / even.iter().sum::<f32>();
    for m in &mut even {
        *m *= sum;
    }
    let mut floors: Vec<Vec3> = (inertias.iter().zip(masses.iter().zip(&ratios)))
        .map(|(i, (m, r))| *i * (r * scale / m))
        .collect();
    let mut below = vec![0.0; masses.len()];
    for i in (0..masses.len()).rev() {
        let largest = floors[i].max_element();
        if below[i] > 0.0 {
            let floor = (2.0 * largest).min(below[i]);
            floors[i] = floors[i].max(Vec3::splat(floor));
        }
        if let Some(p) = parents[i] {
            below[p] += largest + below[i];
        }
    }
    for i in 0..masses.len() {
        let (a, b) = (inertias[i], floors[i]);
        inertias[i] = Vec3::new(between(a.x, b.x), between(a.y, b.y), between(a.z, b.z));
        masses[i] = even[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PARENTS: [Option<usize>; 4] = [None, Some(0), Some(1), Some(0)];

    fn figure() -> ([f32; 4], [Vec3; 4]) {
        let inertia = |m: f32| Vec3::new(0.001, 0.01, 0.01) * m;
        let masses = [10.0, 8.0, 0.4, 9.0];
        (masses, masses.map(inertia))
    }

    #[test]
    fn the_whole_keeps_its_mass_and_neighbours_come_near() {
        let (mut masses, mut inertias) = figure();
        condition(&mut masses, &mut inertias, &PARENTS, 1.0);
        assert!((masses.iter().sum::<f32>() - 27.4).abs() < 1.0e-4);
        for (i, parent) in PARENTS.iter().enumerate() {
            if let Some(p) = parent {
                let ratio = masses[i] / masses[*p];
                assert!((0.799..=1.201).contains(&ratio), "{i}: {ratio}");
            }
        }
        assert!(inertias[1].min_element() >= inertias[2].max_element() * 0.99);
    }

    #[test]
    fn none_of_it_changes_nothing_and_half_lies_between() {
        let (mut masses, mut inertias) = figure();
        condition(&mut masses, &mut inertias, &PARENTS, 0.0);
        assert_eq!((masses, inertias), figure());
        condition(&mut masses, &mut inertias, &PARENTS, 0.5);
        assert!(masses[2] > 0.4 && masses[2] < 3.0, "{masses:?}");
        assert!((masses.iter().sum::<f32>() - 27.4).abs() < 1.0e-4);
    }
}
