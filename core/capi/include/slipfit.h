/* slipfit: the predictor, the flash table and the monitor. SI units. Generated from core/capi/src.
 *
 * Every object lives in memory of the caller's, which has to be written once (static memory is) before its first use;
 * there is no global state. Calls that take an object by a const pointer only read it, so that an interrupt and a thread
 * may make them at once; any other call needs the object to itself. Whatever is made of a table keeps what it needs of it.
 *
 * The archive needs no flags of the linker; -Wl,--gc-sections leaves out what a program does not call. It has no panic handler,
 * so that another library of Rust links beside it. How the caller is compiled changes no bit of the library, not -ffp-contract
 * either. The header is C11 and C++17. */

#ifndef SLIPFIT_H
#define SLIPFIT_H

#include <stddef.h>
#include <stdint.h>

// The version of the library, 10000·major + 100·minor + patch.
#define SLIPFIT_VERSION 200

// Implicit Euler with four Newton passes.
#define SLIPFIT_SCHEME_IMPLICIT_EULER 1

// Regularised Coulomb friction.
#define SLIPFIT_FRICTION_REGULARISED 1

// Coulomb friction with true stick.
#define SLIPFIT_FRICTION_EXACT 2

// The most periods by which the clock of a prediction may start before the unit's release.
#define SLIPFIT_AHEAD_EARLY_MOST 1000

// The most attempts at a step in a period.
#define SLIPFIT_AHEAD_ATTEMPTS_MOST 16

// The second axis of a table is time (s).
#define SLIPFIT_AXIS_TIME 2

// The second axis of a table is position (m), from the motion's start on.
#define SLIPFIT_AXIS_POSITION 3

// The greatest programming word (bytes).
#define SLIPFIT_WORD_MOST 32

// Levels that a bank has room for.
#define SLIPFIT_BANK_LEVELS_MOST 96

// Too early to say.
#define SLIPFIT_BLIND 0

// As the table has it.
#define SLIPFIT_FREE 1

// More force in the direction of the command than the table's for this unit's level, or rising away from it.
#define SLIPFIT_TIGHT 2

// Standing still against the command, or at the limit of force.
#define SLIPFIT_JAM 3

// For the time `hold` of the limits no sample was of use: a number was missing, as of a dead sensor, or the table has no force
// then.
#define SLIPFIT_NO_DATA 4

// The motion has come to the end of a table of a production, beyond which nothing is watched.
#define SLIPFIT_ENDED 5

// Size of a saved unit (bytes).
#define SLIPFIT_UNIT_SIZE 112

// 0 if a function did what it says, or why it did nothing.
typedef int32_t slipfit_status;

// Memory of a predictor; opaque.
typedef struct slipfit_predictor {
  uint64_t words[128];
} slipfit_predictor;

// A scene: a slide over the production, SI units, as `slipfit kernel SCENE -o scene.h` writes it.
typedef struct slipfit_scene {
  // SLIPFIT_SCHEME_IMPLICIT_EULER.
  uint32_t scheme;
  // Step (s).
  float step;
  // Mass (kg).
  float mass;
  // Principal moments of inertia about the centre of mass (kg·m²).
  float inertia[3];
  // Gravity (m/s²).
  float gravity[3];
  // Positions of the pins from the centre of mass (m): x, y, z of each.
  float pins[4][3];
  // Means of the gaps (m): left, right, rail, wall of each pin; 1e6 for none.
  float gap_means[16];
  // Standard deviations of the gaps (m), not negative.
  float gap_deviations[16];
  // Contact stiffness (N/m^e).
  float stiffness;
  // Contact exponent e; the library is built for 1.5.
  float exponent;
  // Contact damping (N·s/m).
  float damping;
  // Depth of full damping (m).
  float depth;
  // SLIPFIT_FRICTION_REGULARISED or SLIPFIT_FRICTION_EXACT; the library is built for one of the two.
  uint32_t friction_law;
  // Coefficient of friction.
  float friction_coefficient;
  // Stick band of regularised friction (m/s); ignored by exact friction.
  float friction_stick_band;
  // Gain of the drive (N·s/m).
  float drive_gain;
  // Start and end of the drive's ramp (s).
  float drive_ramp[2];
  // Commanded speed at the end of the ramp (m/s).
  float drive_speed;
  // Where the drive pushes, from the centre of mass (m).
  float drive_point[3];
} slipfit_scene;

// What a predictor says after a step.
typedef struct slipfit_prediction {
  // Time (s).
  float time;
  // Force of the drive (N).
  float force;
  // Velocity along the drive (m/s).
  float velocity;
  // How far the slide is along the drive (m), from where it was at rest.
  float position;
  // Imbalance of momentum (N·s) that the step left; infinite if it was not finite.
  float residual;
} slipfit_prediction;

// Memory of an observer; opaque.
typedef struct slipfit_observer {
  uint64_t words[4];
} slipfit_observer;

// Memory of a prediction ahead of the clock; opaque.
typedef struct slipfit_ahead {
  uint32_t words[4231];
} slipfit_ahead;

// What prediction ahead of the clock is held to.
typedef struct slipfit_ahead_limits {
  // Time from one step to the next (s).
  float period;
  // Error of the drive's force (N) that is aimed at.
  float tolerance;
  // The lead over the clock that is not exceeded (s), 4 to 1000 periods.
  float lead;
  // The lag behind the clock (s) at which steps are forced, whatever their error, 4 to 1000 periods.
  float lag;
  // Attempts at a step in each period, 1 to SLIPFIT_AHEAD_ATTEMPTS_MOST: 1 for strokes, 2 for planned commands that reverse,
  // 3 or 4 for commands that are followed.
  uint32_t attempts;
} slipfit_ahead_limits;

// What a prediction ahead of the clock says after a step.
typedef struct slipfit_ahead_prediction {
  // The time (s) that force and velocity hold for: the clock's, or an earlier one where the prediction is behind.
  float time;
  // Force of the drive (N).
  float force;
  // Velocity along the drive (m/s).
  float velocity;
  // How far the slide is along the drive (m), from where it was at rest.
  float position;
  // Of a followed command: the commanded speed (m/s) minus the extrapolated one by which this instant was predicted. 0
  // where it had not been predicted before, where the prediction is behind, and for other commands.
  float deviation;
  // How far beyond the clock the motion is known (s); negative where the prediction is behind.
  float lead;
  // The tolerance (N) that the step was held to; infinite for a forced one.
  float tolerance;
  // Sum of the estimated errors (N) of all steps as far as they exceed the tolerance of the limits; without forced steps.
  float excess;
  // Steps forced so far: their error is not known.
  uint32_t forced;
} slipfit_ahead_prediction;

// Memory of an open table over two axes; opaque. The table itself stays where it is.
typedef struct slipfit_table {
  uint64_t words[40];
} slipfit_table;

// Memory of an open table over three axes; opaque. The table itself stays where it is.
typedef struct slipfit_table3 {
  uint64_t words[48];
} slipfit_table3;

// What a table says about one point.
typedef struct slipfit_lookup {
  // Force (N).
  float force;
  // Velocity (m/s).
  float velocity;
  // 1 if the point lay outside the grid or was not a number, 0 if not.
  uint32_t clamped;
  // 1 if the point lies between motions whose verdicts differ, such as a unit that runs and one that jams, so that these are
  // values of no unit; 0 if not.
  uint32_t mixed;
} slipfit_lookup;

// Memory of a table at one level, for lookups in integers; opaque. The table itself stays where it is.
typedef struct slipfit_integers {
  uint64_t words[16];
} slipfit_integers;

// What a table says about one point, in its own integers.
typedef struct slipfit_integer_lookup {
  // Force, in the units of the table's forces.
  int32_t force;
  // Velocity, in the units of its velocities.
  int32_t velocity;
  // 1 if the point or the level lay outside the grid, 0 if not.
  uint32_t clamped;
  // 1 if the level lies between motions whose verdicts differ, 0 if not.
  uint32_t mixed;
} slipfit_integer_lookup;

// Two slots of flash, of which each can be erased on its own.
typedef struct slipfit_slots {
  // The first slot; null if it cannot be read: flash with an error-correcting code faults where a word was cut off. Such a
  // slot holds no finished update.
  const uint8_t *first;
  // The second slot, likewise.
  const uint8_t *second;
  // Length of each (bytes).
  uint32_t length;
  // The programming word of the flash (bytes): 1, 2, 4, 8, 16 or 32.
  uint32_t word;
} slipfit_slots;

// Where an update goes.
typedef struct slipfit_spare {
  // The slot, 0 or 1.
  uint32_t slot;
  // The sequence number of its record, for slipfit_record_make.
  uint32_t sequence;
  // How long the table may be (bytes).
  uint32_t room;
} slipfit_spare;

// The end of a slot, which says that the table in it is the newest.
typedef struct slipfit_record {
  // How many bytes it has: whole programming words.
  uint32_t size;
  // The bytes, to be written to the last `size` bytes of the slot.
  uint8_t bytes[32];
} slipfit_record;

// Memory of a cyclic check; opaque.
typedef struct slipfit_scrubber {
  uint64_t words[8];
} slipfit_scrubber;

// Memory of a watch by a production and of its stroke; opaque. The table itself stays where it is.
typedef struct slipfit_watch {
  uint64_t words[96];
} slipfit_watch;

// Memory of a deadline; opaque.
typedef struct slipfit_deadline {
  uint32_t words[8];
} slipfit_deadline;

// The timing of an interrupt since its first call. No count wraps around.
typedef struct slipfit_timing {
  // Calls that have begun.
  uint32_t calls;
  // Periods in which no call began. A call that begins up to half a period late is in its own.
  uint32_t missed;
  // The longest call, in ticks of the counter.
  uint32_t longest;
  // Calls that took longer than a period.
  uint32_t overruns;
} slipfit_timing;

// Where free ends, and when a jam is one.
typedef struct slipfit_limits {
  // Time from one sample to the next (s).
  float period;
  // Until this time (s) of the motion only the force limit counts.
  float blind;
  // A force (N) beyond which it is a jam, either sign.
  float force_most;
  // How long (s) a jam's sign has to last before it is reported, and how long no sample has to be of use before there is no data.
  float hold;
  // Time constant (s) over which force is averaged.
  float smoothing;
  // By how many levels a unit may be tighter than it is taken for. By fewer where the table ends, or where its units end
  // differently from this one.
  float band;
  // What the averaged force (N) may differ from the table's beyond that band.
  float margin;
  // How fast (N/s) the averaged force may rise away from the table's.
  float rise;
} slipfit_limits;

// Memory of a monitor; opaque.
typedef struct slipfit_monitor {
  uint64_t words[48];
} slipfit_monitor;

// What the drive measures once a period. Of what it cannot measure, a force is given as 0 and a speed as the command, which say
// nothing. What it fails to measure is NAN.
typedef struct slipfit_sample {
  // Time since the motion's start (s).
  float time;
  // The drive's force (N).
  float force;
  // The speed along the drive (m/s).
  float speed;
  // The commanded speed (m/s).
  float command;
} slipfit_sample;

// What a monitor says of a sample.
typedef struct slipfit_report {
  // SLIPFIT_BLIND, SLIPFIT_FREE, SLIPFIT_TIGHT, SLIPFIT_JAM or SLIPFIT_NO_DATA.
  uint32_t verdict;
  // The force (N) that the table has for this unit now.
  float expected;
  // By how much (N) the averaged force may exceed it.
  float band;
  // By how much (N) it does, in the direction of the command.
  float excess;
  // How fast (N/s) that rises.
  float rise;
} slipfit_report;

// A tolerance level and how well it is known.
typedef struct slipfit_estimate {
  // The level that fits best.
  float level;
  // Its standard error; infinite if any level of the table would do.
  float deviation;
  // Ends of the interval of 95 % confidence.
  float low;
  // See `low`.
  float high;
  // Standard deviation (N) of the force from the table's at that level.
  float residual;
} slipfit_estimate;

// Memory of a bank; opaque.
typedef struct slipfit_bank {
  uint64_t words[240];
} slipfit_bank;

// Memory of a jam watch; opaque.
typedef struct slipfit_jam_watch {
  uint64_t words[8];
} slipfit_jam_watch;

// Memory of what is known of a unit; opaque.
typedef struct slipfit_unit {
  uint64_t words[16];
} slipfit_unit;

// What the drive measures once a period, for a watch by a production. What it fails to measure is NAN.
typedef struct slipfit_production_sample {
  // Time since the motion's start (s), or position (m), as the table has it.
  float at;
  // The drive's force (N).
  float force;
  // The speed along the drive (m/s).
  float speed;
  // The commanded speed (m/s).
  float command;
} slipfit_production_sample;

// What a watch by a production says of a sample.
typedef struct slipfit_production_report {
  // SLIPFIT_BLIND, SLIPFIT_FREE, SLIPFIT_TIGHT, SLIPFIT_JAM, SLIPFIT_NO_DATA or SLIPFIT_ENDED.
  uint32_t verdict;
  // The force (N) that is expected of this unit now, with what this stroke has told of its friction so far.
  float expected;
  // The force (N) that was expected before the stroke: before the unit is taught that of the mean.
  float own;
  // The speed (m/s) that is expected.
  float speed;
  // By how much (N) the smoothed force exceeds the expected one, in the direction of the command.
  float excess;
  // By how much (N) it may.
  float limit;
} slipfit_production_report;

// What a whole stroke says.
typedef struct slipfit_stroke_end {
  // SLIPFIT_JAM or SLIPFIT_TIGHT if a sample said so, SLIPFIT_TIGHT if the friction has risen, SLIPFIT_NO_DATA if pieces of the stroke are
  // missing, else SLIPFIT_FREE.
  uint32_t verdict;
  // 1 if the unit was learned from it, 0 if not.
  uint32_t learned;
  // By what share the friction is above that of the unit's first strokes; 0 before the fourth.
  float rise;
  // The standard deviation of that; infinite before the fourth.
  float deviation;
} slipfit_stroke_end;

// How the friction of a unit changes over its strokes.
typedef struct slipfit_wear {
  // Rise of the friction now, as a share of that of the first strokes.
  float rise;
  // Rise a stroke.
  float slope;
  // Standard deviation of the slope.
  float deviation;
  // Strokes until one unit in a hundred would not complete its stroke, by the slope; infinite where it does not rise.
  float strokes_left;
  // The same by the steepest slope that is as likely as 1 in 20.
  float strokes_left_least;
} slipfit_wear;

// Done.
#define SLIPFIT_OK 0

// A pointer is null.
#define SLIPFIT_NULL 1

// A pointer is not aligned as its type asks for.
#define SLIPFIT_MISALIGNED 2

// A length exceeds the address space, or is not one of whole words.
#define SLIPFIT_LENGTH 3

// The object was not made, or making it failed.
#define SLIPFIT_NOT_MADE 4

// A parameter is not finite or out of bounds.
#define SLIPFIT_PARAMETER 5

// The scene asks for laws or a scheme that the library was not built with.
#define SLIPFIT_LAW 6

// The motion left the finite range and was held where it was.
#define SLIPFIT_NOT_FINITE 7

// The scene's step is too large for the unit.
#define SLIPFIT_STEP 8

// The prediction is behind the clock: what it says holds for an earlier time.
#define SLIPFIT_BEHIND 9

// The motion is already predicted for that instant.
#define SLIPFIT_LATE 10

// The header that the program was compiled with is not the library's.
#define SLIPFIT_HEADER 11

// The region ends before the table does.
#define SLIPFIT_TABLE_TRUNCATED 16

// No table starts there.
#define SLIPFIT_TABLE_MAGIC 17

// The table has another version of the format.
#define SLIPFIT_TABLE_VERSION 18

// The table is damaged.
#define SLIPFIT_TABLE_CHECKSUM 19

// A field of the table's header is out of bounds.
#define SLIPFIT_TABLE_HEADER 20

// A value of the table is out of bounds; of an open table: it has changed since.
#define SLIPFIT_TABLE_VALUE 21

// The table is over another number of axes.
#define SLIPFIT_TABLE_AXES 22

// The table was made for another scene or other laws.
#define SLIPFIT_TABLE_SCENE 23

// The table is over another quantity than asked for: over position instead of time, say.
#define SLIPFIT_TABLE_KIND 24

// The slot has no room for the record behind its table, or does not end between programming words.
#define SLIPFIT_TABLE_SLOT 25

// The table's values are f32, where integers are asked for.
#define SLIPFIT_TABLE_ENCODING 26

// The table has more levels than a bank.
#define SLIPFIT_BANK_LEVELS 32

// Too few samples for an estimate.
#define SLIPFIT_BANK_SAMPLES 33

// The estimate is of no unit of the table, not within the band of the level that the monitor was made for, or less certain than
// that band.
#define SLIPFIT_MONITOR_BAND 34

// The table has no unit of the level: those on either side end differently, one runs and one jams, say.
#define SLIPFIT_MONITOR_MIXED 35

// No unit was saved there, or by another version.
#define SLIPFIT_UNIT_MAGIC 40

// The saved unit is damaged.
#define SLIPFIT_UNIT_CHECKSUM 41

// The unit was saved for another scene or other laws.
#define SLIPFIT_UNIT_SCENE 42

// Too few strokes to say.
#define SLIPFIT_UNIT_STROKES 43

// What the sizes of the structs come to: the second argument of slipfit_check_header.
#define SLIPFIT_LAYOUT (((((((((((((((((((((((((((((((0u * 31u + sizeof(slipfit_ahead))\
 * 31u + sizeof(slipfit_ahead_limits))\
 * 31u + sizeof(slipfit_ahead_prediction))\
 * 31u + sizeof(slipfit_bank))\
 * 31u + sizeof(slipfit_deadline))\
 * 31u + sizeof(slipfit_estimate))\
 * 31u + sizeof(slipfit_integer_lookup))\
 * 31u + sizeof(slipfit_integers))\
 * 31u + sizeof(slipfit_jam_watch))\
 * 31u + sizeof(slipfit_limits))\
 * 31u + sizeof(slipfit_lookup))\
 * 31u + sizeof(slipfit_monitor))\
 * 31u + sizeof(slipfit_observer))\
 * 31u + sizeof(slipfit_prediction))\
 * 31u + sizeof(slipfit_predictor))\
 * 31u + sizeof(slipfit_production_report))\
 * 31u + sizeof(slipfit_production_sample))\
 * 31u + sizeof(slipfit_record))\
 * 31u + sizeof(slipfit_report))\
 * 31u + sizeof(slipfit_sample))\
 * 31u + sizeof(slipfit_scene))\
 * 31u + sizeof(slipfit_scrubber))\
 * 31u + sizeof(slipfit_slots))\
 * 31u + sizeof(slipfit_spare))\
 * 31u + sizeof(slipfit_stroke_end))\
 * 31u + sizeof(slipfit_table))\
 * 31u + sizeof(slipfit_table3))\
 * 31u + sizeof(slipfit_timing))\
 * 31u + sizeof(slipfit_unit))\
 * 31u + sizeof(slipfit_watch))\
 * 31u + sizeof(slipfit_wear))

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// The version of the library that is linked, to be compared with the header's `SLIPFIT_VERSION`.
uint32_t slipfit_version(void);

// What a status is called, such as `SLIPFIT_OK`; `unknown` for what no function returns. Ends with a zero, and stays.
const char *slipfit_status_name(slipfit_status status);

// Call it once, as slipfit_check_header(SLIPFIT_VERSION, SLIPFIT_LAYOUT): SLIPFIT_HEADER if the program was compiled with a header of
// another version, or with structs of other sizes, than the library that is linked.
slipfit_status slipfit_check_header(uint32_t version,
                                    size_t layout);

// Makes a predictor in `*predictor` for a unit of tolerance level `n` (-20 to 20) of `*scene`, at rest at time 0. It is tried over
// its first 50 steps, which takes as long as 150: SLIPFIT_STEP if half the step would change the drive's force by more than a
// tenth of the greatest, gain times speed plus the weight, or the motion cannot be moved. A step above 1 ms is halved down to
// that, and each of the halves tried so.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*predictor` meanwhile.
slipfit_status slipfit_predictor_init(struct slipfit_predictor *storage,
                                      const struct slipfit_scene *scene,
                                      float n);

// Moves the predictor by one step; SLIPFIT_NOT_FINITE if the motion could not be moved and was held.
//
// # Safety
// As for slipfit_predictor_init; the memory has been written before.
slipfit_status slipfit_predictor_step(struct slipfit_predictor *storage);

// From the coming step on the commanded speed is `speed` (m/s, within 1000 either way), in place of the scene's ramp, until another one
// is set: any motion, reversals and stops too, once a period.
//
// # Safety
// As for slipfit_predictor_step.
slipfit_status slipfit_predictor_set_command(struct slipfit_predictor *storage,
                                             float speed);

// The unit is at rest at time 0 again, without the trial that making it takes. Its command is the scene's ramp, or what was set last.
//
// # Safety
// As for slipfit_predictor_step.
slipfit_status slipfit_predictor_restart(struct slipfit_predictor *storage);

// What the predictor says now.
//
// # Safety
// As for slipfit_predictor_step; nobody else uses `*prediction` meanwhile.
slipfit_status slipfit_predictor_read(const struct slipfit_predictor *storage, struct slipfit_prediction *prediction);

// Makes an observer in `*storage` for predictors of `*scene`: the standard deviations of a measured speed, `speed_noise` (m/s), and of
// what the force that the model lacks changes by in a step, `force_noise` (N). That force stays within the greatest that drive and
// weight have.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
slipfit_status slipfit_observer_init(struct slipfit_observer *storage,
                                     const struct slipfit_scene *scene,
                                     float speed_noise,
                                     float force_noise);

// Moves `*predictor` by one step under the commanded speed `command` (m/s, within 1000 either way), corrected by the speed that was
// `measured` (m/s) at the end of the step; NAN if none was. Its force is then the real drive's, of the corrected speed.
// SLIPFIT_NOT_FINITE if the motion could not be moved and was held.
//
// # Safety
// As for slipfit_observer_init; the memory of both has been written before; nobody else uses `*predictor` meanwhile.
slipfit_status slipfit_observer_step(struct slipfit_observer *storage,
                                     struct slipfit_predictor *predictor,
                                     float command,
                                     float measured);

// Sets `*force` to the force (N) along the drive that the model lacks: negative where the unit is harder to move than the model's.
//
// # Safety
// As for slipfit_observer_step; nobody else uses `*force` meanwhile.
slipfit_status slipfit_observer_missing(const struct slipfit_observer *storage,
                                        float *force);

// The model lacks nothing again: for another unit.
//
// # Safety
// As for slipfit_observer_step.
slipfit_status slipfit_observer_restart(struct slipfit_observer *storage);

// Makes a prediction ahead of the clock in `*storage` for a unit of tolerance level `n` (-20 to 20) of `*scene`, at rest until its release at
// time 0. Its clock starts `early` periods before, SLIPFIT_AHEAD_EARLY_MOST at most, in which it takes a lead. Its command is the
// scene's ramp until slipfit_ahead_plan or slipfit_ahead_follow sets another. The scene's scheme and step do not matter. Its
// friction must be regularised, also in a library that is built for exact friction: instead of that take a stick band of 10 to 30 µm/s,
// or SLIPFIT_LAW is the answer.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
slipfit_status slipfit_ahead_init(struct slipfit_ahead *storage,
                                  const struct slipfit_scene *scene,
                                  float n,
                                  const struct slipfit_ahead_limits *limits,
                                  uint32_t early);

// The unit is at rest again until its release at time 0, `early` periods from now, with the scene's ramp as its command.
//
// # Safety
// As for slipfit_ahead_step.
slipfit_status slipfit_ahead_rest(struct slipfit_ahead *storage,
                                  uint32_t early);

// Writes to `*periods` how many periods after the end of the coming one a command may be planned: the horizon.
//
// # Safety
// As for slipfit_ahead_read.
slipfit_status slipfit_ahead_horizon(const struct slipfit_ahead *storage, uint32_t *periods);

// The commanded `speed` (m/s, within 1000 either way) so many `periods` after the end of the coming one, of a command that is known in
// advance, in place of the scene's ramp. After slipfit_ahead_init, _rest and _restart plan all periods from 0 to the horizon, then the
// horizon once a period before each step. The first one then holds up to the horizon, until the next ones are set. SLIPFIT_PARAMETER beyond
// the horizon; SLIPFIT_LATE if the motion is already predicted for that instant: slipfit_ahead_restart takes that back.
//
// # Safety
// As for slipfit_ahead_step.
slipfit_status slipfit_ahead_plan(struct slipfit_ahead *storage,
                                  uint32_t periods,
                                  float speed);

// The commanded `speed` (m/s, within 1000 either way) at the end of the coming period, of a command that is not known in advance, in
// place of the scene's ramp; once a period, before slipfit_ahead_step. It is extrapolated to the horizon by a parabola through the last eight
// periods; at first and after slipfit_ahead_restart as constant, until eight periods are known.
//
// # Safety
// As for slipfit_ahead_step.
slipfit_status slipfit_ahead_follow(struct slipfit_ahead *storage,
                                    float speed);

// One period, in the same instructions whatever the motion does: the clock goes on by it, and steps are attempted.
// SLIPFIT_BEHIND if the motion is not known at the new instant.
//
// # Safety
// As for slipfit_ahead_init; the memory has been written before.
slipfit_status slipfit_ahead_step(struct slipfit_ahead *storage);

// What the prediction says now. SLIPFIT_BEHIND if that holds for an earlier time than the clock's, which `*prediction` then
// says.
//
// # Safety
// As for slipfit_ahead_step; nobody else uses `*prediction` meanwhile.
slipfit_status slipfit_ahead_read(const struct slipfit_ahead *storage,
                                  struct slipfit_ahead_prediction *prediction);

// Writes to `*force` (N) what the drive gives so many `periods` after the present instant. SLIPFIT_BEHIND if that is beyond the lead.
//
// # Safety
// As for slipfit_ahead_read.
slipfit_status slipfit_ahead_forecast(const struct slipfit_ahead *storage,
                                      uint32_t periods,
                                      float *force);

// Goes on from the motion at the present instant as a unit of tolerance level `n` of `*scene`: for when the command or what is
// known of the unit changes. The clock runs on, and the scene's ramp counts from the same time 0; a command that was set stays
// until it is set again, from the coming period on. Where the prediction is behind, it goes on from the last motion known. It keeps its limits, and
// if it is refused everything else too.
//
// # Safety
// As for slipfit_ahead_step.
slipfit_status slipfit_ahead_restart(struct slipfit_ahead *storage,
                                     const struct slipfit_scene *scene,
                                     float n);

// Checks the table at `region` completely and opens it in `*storage`. It must be over tolerance level and `over`,
// SLIPFIT_AXIS_TIME or SLIPFIT_AXIS_POSITION, and made for `scene_hash`: SLIPFIT_SCENE_HASH of the scene's header.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; `length` bytes are at `region` and stay
// as they are for as long as the table is used; nobody else uses `*storage` meanwhile.
slipfit_status slipfit_table_open(struct slipfit_table *storage,
                                  const uint8_t *region,
                                  uint32_t length,
                                  uint32_t over,
                                  uint64_t scene_hash);

// As slipfit_table_open, a table over tolerance level, position and commanded speed.
//
// # Safety
// As for slipfit_table_open.
slipfit_status slipfit_table3_open(struct slipfit_table3 *storage,
                                   const uint8_t *region,
                                   uint32_t length,
                                   uint64_t scene_hash);

// Force and velocity of a unit of tolerance level `n` at `at`, the time (s) or position (m) since the motion's start.
// SLIPFIT_TABLE_VALUE if one of them lay outside the range of the table's own values, so that the table has changed since it was
// opened; then `*lookup` has the end of that range. What changes within it, a slipfit_scrubber alone finds.
//
// # Safety
// As for slipfit_table_open; the memory has been written before; nobody else uses `*lookup` meanwhile.
slipfit_status slipfit_table_look_up(const struct slipfit_table *storage,
                                     float n,
                                     float at,
                                     struct slipfit_lookup *lookup);

// Force and velocity of a unit of tolerance level `n` at the position `z` (m), commanded to `speed` (m/s). As
// slipfit_table_look_up.
//
// # Safety
// As for slipfit_table_look_up.
slipfit_status slipfit_table3_look_up(const struct slipfit_table3 *storage,
                                      float n,
                                      float z,
                                      float speed,
                                      struct slipfit_lookup *lookup);

// Makes a table of i16 at the tolerance level `n` in `*storage`, for counts of `unit` along its second axis (s or m): 0.001 for
// milliseconds. It must be no greater than the distance of two nodes. Only this call uses floating point. SLIPFIT_TABLE_ENCODING if the
// table's values are f32: `slipfit table --max-error` makes one of i16.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; the table has been written before, and its bytes stay as
// they are for as long as this is used; nobody else uses `*storage` meanwhile.
slipfit_status slipfit_integers_init(struct slipfit_integers *storage,
                                     const struct slipfit_table *table,
                                     float n,
                                     float unit);

// Writes to `*force` (N) and `*velocity` (m/s) what an integer of 1 stands for.
//
// # Safety
// As for slipfit_integers_look_up.
slipfit_status slipfit_integers_scales(const struct slipfit_integers *storage, float *force, float *velocity);

// Force and velocity `at` so many counts of the unit. SLIPFIT_TABLE_VALUE as for slipfit_table_look_up.
//
// # Safety
// As for slipfit_integers_init; the memory has been written before; nobody else uses `*lookup` meanwhile.
slipfit_status slipfit_integers_look_up(const struct slipfit_integers *storage,
                                        int32_t at,
                                        struct slipfit_integer_lookup *lookup);

// Opens the newer valid table, as slipfit_table_open has it, of two slots, and says where the next update goes: erase that
// slot, write the table to its start, open it there, then write what slipfit_record_make gives to its end. A power cut at any
// moment of it leaves a valid table.
//
// If it fails no table is open, and `*spare` is as it was. Without any valid table an update goes to slot 0 with number 0.
//
// # Safety
// As for slipfit_table_open; nobody else uses `*spare` meanwhile.
slipfit_status slipfit_slots_open(struct slipfit_table *storage,
                                  const struct slipfit_slots *slots,
                                  uint32_t over,
                                  uint64_t scene_hash,
                                  struct slipfit_spare *spare);

// The record of a sequence number for flash with programming words of `word` bytes.
//
// # Safety
// If `record` is neither null nor misaligned, memory for it is there, and nobody else uses it meanwhile.
slipfit_status slipfit_record_make(struct slipfit_record *record, uint32_t word, uint32_t sequence);

// Makes a cyclic check of an open table in `*storage`. The table is only read, at any time and by anybody.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; the table has been written before; nobody
// else uses `*storage` meanwhile.
slipfit_status slipfit_scrubber_init(struct slipfit_scrubber *storage,
                                     const struct slipfit_table *table);

// As slipfit_scrubber_init, of a table over three axes.
//
// # Safety
// As for slipfit_scrubber_init.
slipfit_status slipfit_scrubber_init3(struct slipfit_scrubber *storage, const struct slipfit_table3 *table);

// As slipfit_scrubber_init, of the table of a production that a watch was made by.
//
// # Safety
// As for slipfit_scrubber_init.
slipfit_status slipfit_scrubber_init_watch(struct slipfit_scrubber *storage, const struct slipfit_watch *watch);

// Looks at the next bytes of the table, `most` at most but at least one, and sets `*rounds` one up at the end of a round,
// whatever was found in it. SLIPFIT_TABLE_CHECKSUM at the end of a round in which a byte differed; call it again and again.
//
// # Safety
// As for slipfit_scrubber_init; the memory has been written before; nobody else uses `*rounds` meanwhile.
slipfit_status slipfit_scrubber_check(struct slipfit_scrubber *storage,
                                      uint32_t most,
                                      uint32_t *rounds);

// Writes to `*seal` a hash of the `size` bytes at `object`, a multiple of four, such as an object of this library with its parameters and
// its state. Take it after the last call that changed the object, and compare it before the next use: one flipped
// bit always changes it, and several do but by chance, once in four billion times.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; the object's memory has been written before, and nobody
// writes it meanwhile.
slipfit_status slipfit_seal(const void *object,
                            uint32_t size,
                            uint32_t *seal);

// Makes a deadline in `*storage` for an interrupt every `period` ticks (2 to 2^29) of a counter that counts up and wraps around at 2^32.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
slipfit_status slipfit_deadline_init(struct slipfit_deadline *storage,
                                     uint32_t period);

// A call of the interrupt begins, at `now` of the counter.
//
// # Safety
// As for slipfit_deadline_init; the memory has been written before.
slipfit_status slipfit_deadline_begin(struct slipfit_deadline *storage, uint32_t now);

// The call ends, at `now` of the counter.
//
// # Safety
// As for slipfit_deadline_begin.
slipfit_status slipfit_deadline_end(struct slipfit_deadline *storage, uint32_t now);

// Sets `*timing` to what is known of all calls so far.
//
// # Safety
// As for slipfit_deadline_begin; nobody else uses `*timing` meanwhile.
slipfit_status slipfit_deadline_read(const struct slipfit_deadline *storage, struct slipfit_timing *timing);

// Limits for samples a `period` (s) apart with white noise of standard deviation `noise` (N) on the force: averages over 20
// periods, five standard deviations of what the average leaves of the noise, jams held for ten periods, a band of half a
// level, no blind time and no force limit. SLIPFIT_PARAMETER if no monitor takes them: the period must be 1 µs to 0.5 s, the
// noise not negative.
//
// # Safety
// If `limits` is neither null nor misaligned, memory for them is there, and nobody else uses it meanwhile.
slipfit_status slipfit_limits_for_noise(float period,
                                        float noise,
                                        struct slipfit_limits *limits);

// Makes a monitor in `*storage` of a unit of tolerance level `n`, by an open table over time. The first motion starts with
// it, others with slipfit_monitor_restart. SLIPFIT_MONITOR_MIXED if a lookup at that level would be mixed.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; the table has been written before; nobody
// else uses `*storage` meanwhile.
slipfit_status slipfit_monitor_init(struct slipfit_monitor *storage,
                                    const struct slipfit_table *table,
                                    float n,
                                    const struct slipfit_limits *limits);

// What a sample says, after those before it.
//
// # Safety
// As for slipfit_monitor_init; nobody else uses `*report` meanwhile.
slipfit_status slipfit_monitor_step(struct slipfit_monitor *storage,
                                    const struct slipfit_sample *sample,
                                    struct slipfit_report *report);

// Takes the unit for the level that `*estimate` says from now on. SLIPFIT_MONITOR_BAND, and the level stays, if the estimate is
// of no unit of the table, further than the band of the limits from the `n` of slipfit_monitor_init, or its standard error
// negative or greater than that band. The band does not move along: a unit that leaves it, at once or motion by motion, is tight.
//
// # Safety
// As for slipfit_monitor_init; the monitor has been written before.
slipfit_status slipfit_monitor_adapt(struct slipfit_monitor *storage,
                                     const struct slipfit_estimate *estimate);

// Starts another motion: forgets all samples, and keeps the limits and the level that the unit is taken for.
//
// # Safety
// As for slipfit_monitor_adapt.
slipfit_status slipfit_monitor_restart(struct slipfit_monitor *storage);

// Makes an empty bank in `*storage` for an open table over time, which it goes by until it is made anew.
//
// # Safety
// As for slipfit_monitor_init.
slipfit_status slipfit_bank_init(struct slipfit_bank *storage, const struct slipfit_table *table);

// Adds the force (N) measured at the time `t` (s) of a motion.
//
// # Safety
// As for slipfit_monitor_init; the bank has been written before.
slipfit_status slipfit_bank_add(struct slipfit_bank *storage, float t, float force);

// The tolerance level that fits best.
//
// # Safety
// As for slipfit_bank_add; nobody else uses `*estimate` meanwhile.
slipfit_status slipfit_bank_estimate(const struct slipfit_bank *storage, struct slipfit_estimate *estimate);

// Makes a jam watch in `*storage`, which needs no table: of the limits it goes by `period`, `blind`, `force_most` and `hold`,
// but all must be in bounds, as those of slipfit_limits_for_noise are. The first motion starts with it, others with
// slipfit_jam_watch_restart.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; nobody else uses `*storage` meanwhile.
slipfit_status slipfit_jam_watch_init(struct slipfit_jam_watch *storage,
                                      const struct slipfit_limits *limits);

// Sets `*verdict` to what a sample says, after those before it, as a monitor would: SLIPFIT_BLIND, SLIPFIT_FREE, SLIPFIT_JAM or
// SLIPFIT_NO_DATA, never SLIPFIT_TIGHT. What is NAN neither counts nor starts anew.
//
// # Safety
// As for slipfit_jam_watch_init; the memory has been written before; nobody else uses `*verdict` meanwhile.
slipfit_status slipfit_jam_watch_step(struct slipfit_jam_watch *storage,
                                      const struct slipfit_sample *sample,
                                      uint32_t *verdict);

// Starts another motion: forgets all samples, and keeps the limits.
//
// # Safety
// As for slipfit_jam_watch_init; the memory has been written before.
slipfit_status slipfit_jam_watch_restart(struct slipfit_jam_watch *storage);

// Checks the table of a production at `region` completely and makes a watch by it in `*storage`, at the start of a stroke. The table must be over
// `over`, SLIPFIT_AXIS_TIME or SLIPFIT_AXIS_POSITION, and made for `scene_hash`. Of the strokes of units that complete them the watch gives
// a false alarm in a share `rate`, 1e-6 to 1e-2.
//
// # Safety
// Pointers that are neither null nor misaligned point at what their types say; `length` bytes are at `region` and stay
// as they are for as long as the watch is used; nobody else uses `*storage` meanwhile.
slipfit_status slipfit_watch_init(struct slipfit_watch *storage,
                                  const uint8_t *region,
                                  uint32_t length,
                                  uint32_t over,
                                  uint64_t scene_hash,
                                  float rate);

// Starts another stroke.
//
// # Safety
// As for slipfit_watch_init; the watch has been written before.
slipfit_status slipfit_watch_start(struct slipfit_watch *storage);

// What a sample says of the stroke of `*unit`, after those before it. SLIPFIT_TABLE_VALUE if the table has changed since it was opened; the
// report is written then, too.
//
// # Safety
// As for slipfit_watch_start; the unit has been written before; nobody else uses `*report` meanwhile.
slipfit_status slipfit_watch_step(struct slipfit_watch *storage,
                                  const struct slipfit_unit *unit,
                                  const struct slipfit_production_sample *sample,
                                  struct slipfit_production_report *report);

// What the stroke says as a whole, after its last sample, and what `*unit` learns from it. Call it once a stroke, then
// slipfit_watch_start.
//
// # Safety
// As for slipfit_watch_step; nobody else uses `*unit` and `*end` meanwhile.
slipfit_status slipfit_watch_finish(const struct slipfit_watch *storage,
                                    struct slipfit_unit *unit,
                                    struct slipfit_stroke_end *end);

// How the friction of `*unit` changes over its strokes. SLIPFIT_UNIT_STROKES before the third stroke after its reference of twenty.
//
// # Safety
// As for slipfit_watch_step; nobody else uses `*wear` meanwhile.
slipfit_status slipfit_watch_wear(const struct slipfit_watch *storage,
                                  const struct slipfit_unit *unit,
                                  struct slipfit_wear *wear);

// Makes a unit in `*storage` that has made no stroke: the mean of its production.
//
// # Safety
// If the pointer is neither null nor misaligned, memory for a unit is there, and nobody else uses it meanwhile.
slipfit_status slipfit_unit_init(struct slipfit_unit *storage);

// Writes what is known of a unit to the SLIPFIT_UNIT_SIZE bytes at `saved`, with a checksum, for non-volatile memory.
//
// # Safety
// As for slipfit_unit_init; the unit has been written before; if `saved` is not null, nobody else uses those bytes meanwhile.
slipfit_status slipfit_unit_save(const struct slipfit_unit *storage,
                                 uint64_t scene_hash,
                                 uint8_t *saved);

// Makes the unit in `*storage` that was saved in the SLIPFIT_UNIT_SIZE bytes at `saved`. SLIPFIT_UNIT_MAGIC if none was, SLIPFIT_UNIT_CHECKSUM
// if they have changed, SLIPFIT_UNIT_SCENE if it was saved for another scene.
//
// # Safety
// As for slipfit_unit_init; if `saved` is not null, the bytes are there.
slipfit_status slipfit_unit_load(struct slipfit_unit *storage,
                                 uint64_t scene_hash,
                                 const uint8_t *saved);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* SLIPFIT_H */
