/* A controller's use of slipfit, the same on a host and on a Cortex-M4F: what it prints holds every bit. */
#include "slipfit.h"

#include "scene.h"
#include "table.h"

/* From the platform: prints a text. */
void put(const char *text);

#define STEPS 100000u
#define STROKE 1500u
/* Periods from the clock's start to the release of the unit that is predicted ahead. */
#define EARLY 70u
/* Periods of the predictor's command. */
#define COMMANDED 20000u

static slipfit_predictor predictor;
static slipfit_ahead ahead;
static slipfit_table table;
static slipfit_scrubber scrubber;
static slipfit_monitor monitor;
static slipfit_jam_watch jam_watch;
static slipfit_bank bank;

static void put_hex(const char *name, uint64_t value) {
    char text[18];
    for (int i = 0; i < 16; i++) {
        text[i] = "0123456789abcdef"[value >> (60 - 4 * i) & 15u];
    }
    text[16] = '\n';
    text[17] = 0;
    put(name);
    put(" ");
    put(text);
}

/* FNV-1a over the bits of a number. */
static uint64_t add(uint64_t hash, float number) {
    union {
        float number;
        uint8_t bytes[4];
    } bits = {number};
    for (int i = 0; i < 4; i++) {
        hash = (hash ^ bits.bytes[i]) * 0x100000001b3ull;
    }
    return hash;
}

#define EMPTY 0xcbf29ce484222325ull

static void predict(void) {
    uint64_t hash = EMPTY;
    uint32_t failed = (uint32_t)slipfit_predictor_init(&predictor, &slipfit_this_scene, 2.5f);
    for (uint32_t i = 0; i < STEPS; i++) {
        slipfit_prediction found;
        failed |= (uint32_t)slipfit_predictor_step(&predictor);
        failed |= (uint32_t)slipfit_predictor_read(&predictor, &found);
        hash = add(add(add(add(hash, found.time), found.force), found.velocity), found.residual);
    }
    put_hex("predicted", hash);
    put_hex("failed", failed);
}

/* The command of a period: arcs of parabolas there and back, with the same bits everywhere. */
static float command(uint32_t period) {
    float x = 2.0f * (float)(period % 800u) / 800.0f;
    const float sign = x < 1.0f ? 0.08f : -0.08f;
    x = x < 1.0f ? x : x - 1.0f;
    return sign * 4.0f * x * (1.0f - x);
}

/* Any command, set once a period; the predictor is saved and restored on the way, and a second motion starts from rest. */
static void follow_command(void) {
    static slipfit_predictor saved;
    uint64_t hash = EMPTY;
    uint32_t failed = (uint32_t)slipfit_predictor_restart(&predictor);
    for (uint32_t i = 0; i < COMMANDED; i++) {
        slipfit_prediction found;
        if (i == COMMANDED / 2) {
            saved = predictor;
            failed |= (uint32_t)slipfit_predictor_restart(&predictor);
            failed |= (uint32_t)slipfit_predictor_step(&predictor);
            predictor = saved;
        }
        failed |= (uint32_t)slipfit_predictor_set_command(&predictor, command(i));
        failed |= (uint32_t)slipfit_predictor_step(&predictor);
        failed |= (uint32_t)slipfit_predictor_read(&predictor, &found);
        hash = add(add(add(add(hash, found.time), found.force), found.velocity), found.position);
    }
    put_hex("commanded", hash);
    put_hex("failed", failed);
}

/* Ahead of the clock, through a change of the command and of what is known of the unit; then a planned command, then a followed
 * one. */
static void predict_ahead(void) {
    const slipfit_ahead_limits limits = {.period = 1e-3f, .tolerance = 7e-5f, .lead = 0.2f, .lag = 0.2f, .attempts = 1u};
    slipfit_scene slower = slipfit_this_scene;
    slower.drive_speed = 0.05f;
    uint64_t hash = EMPTY, behind = 0;
    uint32_t failed = (uint32_t)slipfit_ahead_init(&ahead, &slipfit_this_scene, 2.5f, &limits, EARLY);
    uint32_t horizon = 0;
    failed |= (uint32_t)slipfit_ahead_horizon(&ahead, &horizon);
    for (uint32_t i = 0; i < EARLY + 2u * STROKE; i++) {
        slipfit_ahead_prediction found;
        if (i == EARLY + STROKE / 2) {
            failed |= (uint32_t)slipfit_ahead_restart(&ahead, &slower, 2.25f);
        } else if (i >= EARLY + STROKE + STROKE / 2) {
            failed |= (uint32_t)slipfit_ahead_follow(&ahead, command(i));
        } else if (i >= EARLY + STROKE) {
            failed |= (uint32_t)slipfit_ahead_plan(&ahead, horizon, command(i));
        }
        const slipfit_status stepped = slipfit_ahead_step(&ahead);
        failed |= stepped == SLIPFIT_BEHIND ? 0u : (uint32_t)stepped;
        failed |= slipfit_ahead_read(&ahead, &found) == stepped ? 0u : 1u;
        behind += stepped == SLIPFIT_BEHIND;
        hash = add(add(add(add(hash, found.time), found.force), found.velocity), found.lead);
        hash = add(add(add(hash, found.tolerance), found.excess), (float)found.forced);
        hash = add(add(hash, found.position), found.deviation);
    }
    put_hex("ahead", hash);
    put_hex("behind", behind);
    put_hex("failed", failed);
}

static void watch(void) {
    const slipfit_limits limits = {
        .period = 1e-3f, .blind = 0.2f, .force_most = 3.5f, .hold = 0.01f,
        .smoothing = 0.02f, .band = 0.5f, .margin = 0.01f, .rise = 0.5f,
    };
    /* A limit that the force of a good unit exceeds. */
    slipfit_limits weak = limits;
    weak.force_most = 0.9f;
    uint64_t looked_up = EMPTY, watched = EMPTY;
    uint32_t verdicts[5] = {0, 0, 0, 0, 0};
    uint32_t failed = (uint32_t)slipfit_table_open(&table, slipfit_table_bytes, SLIPFIT_TABLE_SIZE, SLIPFIT_AXIS_TIME,
                                                   SLIPFIT_SCENE_HASH);
    uint32_t rounds = 0, jams = 0;
    failed |= (uint32_t)slipfit_scrubber_init(&scrubber, &table);
    failed |= (uint32_t)slipfit_predictor_init(&predictor, &slipfit_this_scene, 2.25f);
    failed |= (uint32_t)slipfit_monitor_init(&monitor, &table, 2.25f, &limits);
    failed |= (uint32_t)slipfit_jam_watch_init(&jam_watch, &weak);
    failed |= (uint32_t)slipfit_bank_init(&bank, &table);
    for (uint32_t i = 0; i < STROKE; i++) {
        slipfit_prediction at;
        slipfit_lookup found;
        slipfit_report report;
        uint32_t jam;
        failed |= (uint32_t)slipfit_predictor_step(&predictor);
        failed |= (uint32_t)slipfit_predictor_read(&predictor, &at);
        failed |= (uint32_t)slipfit_table_look_up(&table, 2.25f, at.time, &found);
        looked_up = add(add(add(looked_up, found.force), found.velocity), (float)(found.clamped + 2 * found.mixed));
        const slipfit_sample sample = {at.time, at.force, at.velocity, at.velocity + at.force / slipfit_this_scene.drive_gain};
        failed |= (uint32_t)slipfit_monitor_step(&monitor, &sample, &report);
        verdicts[report.verdict]++;
        watched = add(add(watched, report.excess), report.band);
        failed |= (uint32_t)slipfit_jam_watch_step(&jam_watch, &sample, &jam);
        jams += jam == SLIPFIT_JAM;
        failed |= (uint32_t)slipfit_bank_add(&bank, at.time, at.force);
        failed |= (uint32_t)slipfit_scrubber_check(&scrubber, 64, &rounds);
    }
    slipfit_estimate estimate;
    failed |= (uint32_t)slipfit_bank_estimate(&bank, &estimate);
    put_hex("looked up", looked_up);
    put_hex("watched", watched);
    put_hex("blind", verdicts[SLIPFIT_BLIND]);
    put_hex("free", verdicts[SLIPFIT_FREE]);
    put_hex("tight", verdicts[SLIPFIT_TIGHT]);
    put_hex("jam", verdicts[SLIPFIT_JAM]);
    put_hex("no data", verdicts[SLIPFIT_NO_DATA]);
    put_hex("jam of a weak drive", jams);
    put_hex("rounds", rounds);
    put_hex("estimate", add(add(add(EMPTY, estimate.level), estimate.low), estimate.high));
    put_hex("failed", failed);
}

/* What an update writes to the end of its slot. */
static void record(void) {
    slipfit_record made;
    uint64_t hash = slipfit_record_make(&made, 16, 7) == SLIPFIT_OK ? EMPTY : 0;
    for (uint32_t i = 0; i < made.size; i++) {
        hash = (hash ^ made.bytes[i]) * 0x100000001b3ull;
    }
    put_hex("record", hash);
}

static void refuse(void) {
    static uint64_t erased[sizeof table / 8 + 1];
    slipfit_lookup found;
    put_hex("null", (uint64_t)slipfit_predictor_init(0, &slipfit_this_scene, 0.0f));
    put_hex("misaligned", (uint64_t)slipfit_predictor_step((slipfit_predictor *)((char *)&predictor + 1)));
    put_hex("not made", (uint64_t)slipfit_table_look_up((const slipfit_table *)erased, 0.0f, 0.0f, &found));
    put_hex("scene", (uint64_t)slipfit_table_open(&table, slipfit_table_bytes, SLIPFIT_TABLE_SIZE, SLIPFIT_AXIS_TIME, 1));
    put_hex("position", (uint64_t)slipfit_table_open(&table, slipfit_table_bytes, SLIPFIT_TABLE_SIZE, SLIPFIT_AXIS_POSITION, SLIPFIT_SCENE_HASH));
    put_hex("closed then", (uint64_t)slipfit_table_look_up(&table, 0.0f, 0.0f, &found));
    put_hex("truncated", (uint64_t)slipfit_table_open(&table, slipfit_table_bytes, SLIPFIT_TABLE_SIZE - 1, SLIPFIT_AXIS_TIME, SLIPFIT_SCENE_HASH));
    put_hex("foreign", (uint64_t)slipfit_table_open(&table, (const uint8_t *)erased, 64, SLIPFIT_AXIS_TIME, SLIPFIT_SCENE_HASH));
}

int main(void) {
    if (slipfit_check_header(SLIPFIT_VERSION, SLIPFIT_LAYOUT) != SLIPFIT_OK ||
        slipfit_check_header(SLIPFIT_VERSION + 1u, SLIPFIT_LAYOUT) != SLIPFIT_HEADER ||
        slipfit_check_header(SLIPFIT_VERSION, SLIPFIT_LAYOUT + 31u) != SLIPFIT_HEADER) {
        put("the header is not the library's\n");
        return 1;
    }
    predict();
    predict_ahead();
    follow_command();
    watch();
    record();
    refuse();
    return 0;
}
