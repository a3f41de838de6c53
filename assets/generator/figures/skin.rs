//! How much each bone holds of a point of the skin: at every joint stands a gate, and the share
//! that passes it goes on to the child.

use bevy::math::DVec3;

use super::skeleton::Skeleton;

/// A gate at the head of a bone: a plane with a soft edge.
#[derive(Clone, Debug)]
pub struct Gate {
    pub bone: usize,
    pub point: DVec3,
    pub normal: DVec3,
    /// Half the thickness of the soft edge, metres.
    pub half: f64,
    /// Soft edge towards the other side of the body, metres, for what comes in pairs.
    pub side: Option<f64>,
    /// Beyond how far from the middle of the body the plane bends, and by how much, metres per
    /// metre: for arms that hang beside a trunk.
    pub wing: [f64; 2],
}

/// The four bones that hold a point most, with weights that add up to 255.
pub type Weights = [(u8, u8); 4];

/// Zero below, one above, smooth between.
pub fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Shares of all bones in a point of the bind pose.
pub fn shares(skeleton: &Skeleton, gates: &[Gate], p: DVec3) -> Vec<f64> {
    let count = skeleton.bones.len();
    let mut pass = vec![0.0; count];
    for gate in gates {
        let ahead = gate.normal.normalize().dot(p - gate.point)
            + gate.wing[1] * (p.x.abs() - gate.wing[0]).max(0.0);
        let mut open = smooth(0.5 + 0.5 * ahead / gate.half);
        if let Some(width) = gate.side {
            open *= smooth(0.5 + 0.5 * p.x * gate.point.x.signum() / width);
        }
        pass[gate.bone] = open;
    }
    // What is left for the bone itself and for children further on in the list.
    let mut left = vec![1.0_f64; count];
    let mut reach = vec![1.0_f64; count];
    for (i, bone) in skeleton.bones.iter().enumerate() {
        if let Some(parent) = bone.parent {
            reach[i] = reach[parent] * left[parent] * pass[i];
            left[parent] *= 1.0 - pass[i];
        }
    }
    (0..count).map(|i| reach[i] * left[i]).collect()
}

/// The four largest shares, rounded so that they add up.
pub fn weights(shares: &[f64]) -> Weights {
    let mut order: Vec<usize> = (0..shares.len()).collect();
    order.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]).then(a.cmp(&b)));
    let sum: f64 = order[..4].iter().map(|&i| shares[i]).sum();
    let mut made = [(0, 0); 4];
    let mut rest = 255;
    for (slot, &bone) in made.iter_mut().zip(&order).skip(1) {
        let weight = (shares[bone] / sum * 255.0).round() as u8;
        if weight > 0 {
            *slot = (bone as u8, weight);
            rest -= weight;
        }
    }
    made[0] = (order[0] as u8, rest);
    made
}
