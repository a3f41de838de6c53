//! A vehicle on steady ground allocates nothing, whatever its wheels feel with, and a ragdoll in no mode,
//! also when its settings are tuned every tick. A test program of its own: the allocator that counts and
//! the pool of one thread are those of the whole process.

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
};

use bevy::{app::TaskPoolOptions, math::ops, prelude::*};
use bevy_embody::{prelude::*, ragdoll::RagdollSystems};
use bevy_rapier3d::prelude::*;
use embody_scenes::{Patch, Sim, harness::around_tick, reference::*};

#[global_allocator]
static ALLOCATOR: Counting = Counting;

thread_local! {
    /// Allocations of this thread while counted, `None` while not.
    static COUNT: Cell<Option<u32>> = const { Cell::new(None) };
}

/// The system's allocator with a counter before it.
struct Counting;

fn note() {
    // A thread that ends has no counter any more.
    let _ = COUNT.try_with(|count| count.set(count.get().map(|n| n + 1)));
}

#[expect(unsafe_code, reason = "an allocator is an unsafe trait")]
// SAFETY: every call goes to the system's allocator unchanged.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note();
        // SAFETY: the caller keeps the contract of the same function.
        unsafe { System.alloc(layout) }
    }

    unsafe fn realloc(&self, at: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note();
        // SAFETY: the caller keeps the contract of the same function.
        unsafe { System.realloc(at, layout, size) }
    }

    unsafe fn dealloc(&self, at: *mut u8, layout: Layout) {
        // SAFETY: the caller keeps the contract of the same function.
        unsafe { System.dealloc(at, layout) }
    }
}

/// Allocations of the systems that are counted so far.
#[derive(Resource, Default)]
struct Allocated(u32);

fn begin() {
    COUNT.set(Some(0));
}

fn end(mut allocated: ResMut<Allocated>) {
    allocated.0 += COUNT.take().unwrap_or(0);
}

/// A world on this one thread whose systems in these sets are counted.
fn counted_sim<S: SystemSet + Copy>(plugin: impl Plugin, sets: [S; 3]) -> Sim {
    let mut pools = TaskPoolOptions::default();
    pools.compute.min_threads = 1;
    pools.compute.max_threads = 1;
    pools.create_default_pools();
    let mut sim = Sim::with(60.0, (EmbodyCorePlugin, plugin));
    sim.app.init_resource::<Allocated>();
    around_tick(&mut sim.app, sets, begin, end);
    sim.in_line()
}

/// Allocations in this many seconds.
fn allocations(sim: &mut Sim, seconds: f64, mut each: impl FnMut(&mut Sim)) -> u32 {
    sim.app.world_mut().resource_mut::<Allocated>().0 = 0;
    for _ in 0..(seconds * 60.0) as usize {
        each(sim);
        sim.ticks(1);
    }
    sim.app.world().resource::<Allocated>().0
}

/// Bodies around the wheels: such as probes begin in, end on and pass by.
fn clutter(sim: &mut Sim) {
    let shapes = [
        Collider::cuboid(0.2, 0.05, 0.2),
        Collider::ball(0.15),
        Collider::capsule_y(0.1, 0.1),
        Collider::cylinder(0.05, 0.2),
        Collider::cone(0.1, 0.2),
        Collider::round_cuboid(0.2, 0.05, 0.2, 0.02),
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        for (x, z) in [(-0.8, -1.4), (0.8, -1.4), (-0.8, 1.4), (0.8, 1.4)] {
            // From below the wheel up to where its probe begins, and beside it.
            for height in [0.05, 0.35, 0.65, 0.95, 1.2] {
                let aside = 0.12 * i as f32 - 0.3;
                let at = Vec3::new(x + aside, height, z);
                // Felt by the wheels, but not by the hull.
                sim.spawn((
                    RigidBody::Fixed,
                    shape.clone(),
                    SolverGroups::new(Group::NONE, Group::NONE),
                    Transform::from_translation(at),
                ));
            }
        }
    }
}

#[test]
fn a_steady_tick_allocates_nothing_with_rays_spheres_or_cylinders() {
    use VehicleSystems::{Drive, Prepare, React};
    let probes = [
        WheelProbe::Ray,
        WheelProbe::Rays { count: 3 },
        WheelProbe::Sphere { radius: 0.2 },
        WheelProbe::Cylinder,
    ];
    let grounds = ["box", "mesh", "clutter"];
    let mut wrong = Vec::new();
    for probe in probes {
        for ground in grounds {
            let mut sim = counted_sim(VehiclePlugin, [Prepare, Drive, React]);
            if ground == "mesh" {
                let wavy = |x: f32, z: f32| 0.05 * ops::sin(x) + 0.05 * ops::cos(z);
                let terrain = Patch::terrain(60, 1.0, wavy);
                sim.fixed(terrain.collider(), Transform::from_xyz(-30.0, 0.0, -30.0));
            } else {
                sim.floor(0.0);
            }
            let plan = Plan::reference()
                .direct(200.0, |_| true)
                .wheel(|_, w| w.probe = probe);
            let car = plan.spawn(&mut sim, Transform::from_xyz(0.0, HEIGHT + 0.15, 0.0));
            match ground {
                "clutter" => clutter(&mut sim),
                // Forces on what is under the wheels have to be written, and taken back.
                "box" => {
                    let plate = Collider::cuboid(1.2, 0.05, 2.0);
                    sim.dynamic(plate, Transform::from_xyz(0.0, 0.05, 0.0), 400.0);
                }
                _ => car.ask(&mut sim, |i| i.throttle = 1.0),
            }
            sim.seconds(2.0);
            let count = allocations(&mut sim, 3.0, |_| ());
            if count > 0 {
                wrong.push(format!("{probe:?} on {ground}: {count}"));
            }
            assert!(car.finite(&sim));
        }
    }
    assert!(wrong.is_empty(), "allocations in 180 ticks: {wrong:?}");
}

#[test]
fn a_ragdoll_whose_settings_are_tuned_every_tick_allocates_nothing() {
    use RagdollSystems::{Drive, Prepare, React};
    let modes = [
        RagdollMode::Animated,
        RagdollMode::HitBoxes,
        RagdollMode::Partial,
        RagdollMode::Powered,
        RagdollMode::Keyframed,
        RagdollMode::Limp,
        RagdollMode::Frozen,
        RagdollMode::GettingUp,
    ];
    let mut wrong = Vec::new();
    for mode in modes {
        for tunes in [false, true] {
            let mut sim = counted_sim(RagdollPlugin, [Prepare, Drive, React]);
            sim.block(Vec3::NEG_Y * 0.5, Vec3::new(20.0, 1.0, 20.0));
            let intent = RagdollIntent { mode, ..default() };
            let entity = sim.spawn((Ragdoll::default(), intent, FollowRoot));
            // Until who falls lies, and that has been told.
            sim.seconds(6.0);
            let count = allocations(&mut sim, 2.0, |sim| {
                if tunes {
                    let mut ragdoll = sim.app.world_mut().get_mut::<Ragdoll>(entity);
                    let ragdoll = ragdoll.as_deref_mut().expect("it is one");
                    ragdoll.drive.frequency += 0.01;
                }
            });
            if count > 0 {
                wrong.push(format!("{mode:?}, tuned {tunes}: {count}"));
            }
        }
    }
    assert!(wrong.is_empty(), "allocations in 120 ticks: {wrong:?}");
}
