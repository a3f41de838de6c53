//! The palette.

/// A material: one calm colour each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Paint {
    Plaza,
    Stone,
    Slate,
    Ink,
    White,
    Teal,
    Coral,
    Indigo,
    Amber,
    Sand,
    Leaf,
    Wood,
    Metal,
    Rose,
    Water,
    Grass,
    Asphalt,
    Wet,
    Ice,
    Red,
    Blue,
    Green,
    Yellow,
    Silver,
    Glass,
    Rubber,
    Lamp,
    Tail,
}

impl Paint {
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }

    /// Colour on the screen, red green blue.
    fn screen(self) -> u32 {
        match self {
            Self::Plaza => 0xded8ca,
            Self::Stone => 0xb9b3a7,
            Self::Slate => 0x5d6873,
            Self::Ink => 0x2e343d,
            Self::White => 0xf6f3ea,
            Self::Teal => 0x4a9d95,
            Self::Coral => 0xd97b5f,
            Self::Indigo => 0x6373b3,
            Self::Amber => 0xe9b94d,
            Self::Sand => 0xdcc48e,
            Self::Leaf => 0x7ba872,
            Self::Wood => 0xa87f56,
            Self::Metal => 0x97a1a9,
            Self::Rose => 0xc4707f,
            Self::Water => 0x3f97c8,
            Self::Grass => 0x8fae76,
            Self::Asphalt => 0x6b6f74,
            Self::Wet => 0x44525e,
            Self::Ice => 0xd4ecf7,
            Self::Red => 0xc93a32,
            Self::Blue => 0x2f62a8,
            Self::Green => 0x5d6f45,
            Self::Yellow => 0xf0b429,
            Self::Silver => 0xc9d0d6,
            Self::Glass => 0x26323d,
            Self::Rubber => 0x26282b,
            Self::Lamp => 0xfff6d8,
            Self::Tail => 0xa61e22,
        }
    }

    pub fn alpha(self) -> f32 {
        if self == Self::Water { 0.5 } else { 1.0 }
    }

    pub fn roughness(self) -> f32 {
        match self {
            Self::Water => 0.1,
            Self::Wet => 0.2,
            Self::Ice | Self::Glass => 0.15,
            Self::Red | Self::Blue | Self::Yellow | Self::Silver => 0.35,
            Self::Metal => 0.45,
            _ => 0.85,
        }
    }

    pub fn metallic(self) -> f32 {
        match self {
            Self::Metal => 0.6,
            Self::Silver => 0.3,
            _ => 0.0,
        }
    }

    /// Linear RGBA as glTF wants it.
    #[expect(
        clippy::disallowed_methods,
        reason = "rounded to three digits right away"
    )]
    pub fn linear(self) -> [f32; 4] {
        let channel = |shift: u32| {
            let value = f64::from((self.screen() >> shift) & 0xff) / 255.0;
            let linear = if value <= 0.04045 {
                value / 12.92
            } else {
                ((value + 0.055) / 1.055).powf(2.4)
            };
            // Three digits are plenty, and the same on every machine.
            ((linear * 1000.0).round() / 1000.0) as f32
        };
        [channel(16), channel(8), channel(0), self.alpha()]
    }
}
