//! What a tyre is made of.

use bevy::prelude::*;

/// A tyre. Plain numbers; every field may change at any time.
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct Tire {
    /// Force against slip along the wheel.
    pub along: TireModel,
    /// Force against the sine of the slip angle across the wheel.
    pub across: TireModel,
    /// Friction coefficient at [`Self::nominal_load`] on a surface of friction 1, dimensionless, at
    /// least 0: along the wheel, across it. At 0 the car is on perfect ice.
    pub friction: Vec2,
    /// Load at which friction and stiffness are as given, newtons, above 0.
    pub nominal_load: f32,
    /// By how much of itself the friction falls when the load doubles, dimensionless, `0..=1`. At 0
    /// friction is Coulomb's; road tyres have 0.05 to 0.2, which makes weight transfer cost grip.
    pub load_sensitivity: f32,
    /// Exponent with which stiffness follows load, dimensionless, `0..=1`. At 0 the stiffness is the
    /// same at every load, at 1 in proportion to it.
    pub stiffness_exponent: f32,
    /// Distance over which force builds up to 63 %, metres, above 0: along, across. Short tyres
    /// answer at once and are stiff; very long ones make the car sway.
    pub relaxation_length: Vec2,
    /// Rolling resistance in parts of the load, dimensionless, at least 0; 0.01 on asphalt, 0.3 in sand.
    pub rolling_resistance: f32,
    /// Slip that a camber of one radian adds, dimensionless; 0 leaves camber thrust out. Tyres have
    /// 0.04 to 0.1: that of a motorcycle whose lean alone carries it has its load over its stiffness.
    pub camber_stiffness: f32,
}

impl Default for Tire {
    fn default() -> Self {
        Self {
            along: TireModel::Brush { stiffness: 90.0e3 },
            across: TireModel::Brush { stiffness: 70.0e3 },
            friction: Vec2::splat(1.0),
            nominal_load: 4000.0,
            load_sensitivity: 0.0,
            stiffness_exponent: 1.0,
            relaxation_length: Vec2::new(0.2, 0.4),
            rolling_resistance: 0.012,
            camber_stiffness: 0.0,
        }
    }
}

/// Force of one axis against slip: the shape of the curve. Slip is dimensionless, the slip ratio or
/// the sine of the slip angle.
#[derive(Reflect, Clone, Debug, PartialEq)]
#[reflect(Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub enum TireModel {
    /// `F = C s`, cut at `µ N`.
    Linear {
        /// Slip stiffness `C` at the nominal load, newtons per unit of slip, above 0.
        stiffness: f32,
    },
    /// Elastic bristles under a parabolic pressure (Fromm, Julien): `F = µN (3x − 3x² + x³)` with
    /// `x = C s / (3 µN)`, full slide from `x = 1` on.
    Brush {
        /// Slip stiffness `C` at the nominal load, newtons per unit of slip, above 0.
        stiffness: f32,
    },
    /// `F = µN sin(c atan(bs − e (bs − atan bs)))` (Pacejka). The slope at 0 is `b c µN`.
    Magic {
        /// Stiffness factor `b`, above 0; road tyres 5 to 20.
        b: f32,
        /// Shape factor `c`, `1..2`: above 1 the force falls behind its peak.
        c: f32,
        /// Curvature factor `e`, at most 1.
        e: f32,
    },
    /// Straight lines through points, from the origin on; constant behind the last one.
    Curve {
        /// Points in the order of their slip, the first slip above 0.
        points: Vec<SlipPoint>,
    },
}

/// A point of a free curve.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Default, Debug, PartialEq, Clone)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
pub struct SlipPoint {
    /// Slip, dimensionless, above 0.
    pub slip: f32,
    /// Force in parts of `µ N`, at least 0.
    pub force: f32,
}
