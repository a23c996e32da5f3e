//! Single values of the contact law and single bounces.

/// Contact of the tables below, mm and N: k = 100 N/mm^1.5, c = 1 N·s/mm, d = 0.1 mm.
/// Penetration (mm), its rate (mm/s), force (N) to seven decimals.
pub const IMPACT_VALUES: [[f64; 3]; 7] = [
    [0.01, 0.0, 0.1],
    [0.05, 100.0, 51.118_034_0],
    [0.05, -10.0, 0.0],
    [0.1, 100.0, 103.162_277_7],
    [0.2, 100.0, 108.944_271_9],
    [0.2, -5.0, 3.944_271_9],
    [0.025, -20.0, 0.0],
];

/// A bounce without gravity of the slide's mass on that contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounce {
    /// Approach speed (m/s).
    pub speed: f64,
    /// Speed after over speed before.
    pub restitution: f64,
    /// Peak penetration (m).
    pub peak_penetration: f64,
    /// Peak force (N).
    pub peak_force: f64,
    /// Time in contact (s).
    pub contact_time: f64,
}

/// Mass that bounces (kg).
pub const BOUNCE_MASS: f64 = 0.0818;

/// Bounces at three speeds, rounded as printed.
pub const BOUNCES: [Bounce; 3] = [
    Bounce {
        speed: 0.01,
        restitution: 0.330_94,
        peak_penetration: 1.694e-5,
        peak_force: 0.4536,
        contact_time: 9.473e-3,
    },
    Bounce {
        speed: 0.1,
        restitution: 0.034_48,
        peak_penetration: 4.593e-5,
        peak_force: 16.4318,
        contact_time: 18.719e-3,
    },
    Bounce {
        speed: 1.0,
        restitution: 0.004_64,
        peak_penetration: 1.3001e-4,
        peak_force: 574.1,
        contact_time: 28.853e-3,
    },
];

/// A ball that bounces on an undamped linear spring, released at rest height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BouncingBall {
    /// Mass (kg).
    pub mass: f64,
    /// Stiffness of the floor (N/m).
    pub stiffness: f64,
    /// Acceleration of free fall (m/s²), positive upwards.
    pub gravity: f64,
    /// Radius (m): the ball touches the floor when its centre is that high.
    pub radius: f64,
    /// Height of the centre at the start (m).
    pub height: f64,
    /// Velocity at the start (m/s), positive upwards.
    pub velocity: f64,
}

/// The ball.
pub const BALL: BouncingBall =
    BouncingBall { mass: 0.25, stiffness: 20e3, gravity: -9.81, radius: 0.05, height: 0.06, velocity: -1.0 };

/// Time (s) and height of the ball's centre (m) then: after 3 impacts, and after 22.
pub const BALL_HEIGHTS: [[f64; 2]; 2] = [[0.5, 0.060_939_776_065_215_1], [5.0, 0.097_253_007_782_5]];

impl BouncingBall {
    /// Total energy (J) at the height `height` (m) of the centre and the velocity `velocity` (m/s).
    pub fn energy(&self, height: f64, velocity: f64) -> f64 {
        let depth = if height < self.radius { self.radius - height } else { 0.0 };
        0.5 * self.mass * velocity * velocity - self.mass * self.gravity * height + 0.5 * self.stiffness * depth * depth
    }
}
