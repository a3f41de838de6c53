//! A vehicle on steady ground allocates nothing, whatever its wheels feel with. A test program of its
//! own: the allocator that counts and the pool of one thread are those of the whole process.

use std::{
    alloc::{GlobalAlloc, Layout, System},
    cell::Cell,
};

use bevy::{app::TaskPoolOptions, math::ops, prelude::*};
use bevy_embody::prelude::*;
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

/// Allocations of the vehicle's systems so far.
#[derive(Resource, Default)]
struct Allocated(u32);

fn begin() {
    COUNT.set(Some(0));
}

fn end(mut allocated: ResMut<Allocated>) {
    allocated.0 += COUNT.take().unwrap_or(0);
}

/// A world on this one thread whose vehicle systems are counted.
fn counted_sim() -> Sim {
    let mut sim = Sim::with(60.0, (EmbodyCorePlugin, VehiclePlugin));
    sim.app.init_resource::<Allocated>();
    let sets = {
        use VehicleSystems::{Drive, Prepare, React};
        [Prepare, Drive, React]
    };
    around_tick(&mut sim.app, sets, begin, end);
    sim.in_line()
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
    let mut pools = TaskPoolOptions::default();
    pools.compute.min_threads = 1;
    pools.compute.max_threads = 1;
    pools.create_default_pools();
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
            let mut sim = counted_sim();
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
            sim.app.world_mut().resource_mut::<Allocated>().0 = 0;
            sim.seconds(3.0);
            let count = sim.app.world().resource::<Allocated>().0;
            if count > 0 {
                wrong.push(format!("{probe:?} on {ground}: {count}"));
            }
            assert!(car.finite(&sim));
        }
    }
    assert!(wrong.is_empty(), "allocations in 180 ticks: {wrong:?}");
}
