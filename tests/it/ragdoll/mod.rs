//! Ragdolls: joints and limits, modes, drive to a pose, what is shown, hits, rest, getting up, limbs cut
//! off, skins, characters that fall, life of bones.

mod balance;
mod blend;
mod character;
mod hits;
mod hold;
mod keyframes;
mod known;
mod known_bodies;
mod known_joints;
mod life;
mod limits;
mod modes;
mod odd;
mod refusals;
mod rest;
mod rise;
mod sever;
mod skin;
mod support;
mod teleport;
