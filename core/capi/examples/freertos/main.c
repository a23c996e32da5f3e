/* FreeRTOS: a task of high priority steps the predictor at 1 kHz, a queue hands each force to a task of low priority. */
#include "FreeRTOS.h"
#include "queue.h"
#include "task.h"

#include "slipfit.h"

#include "scene.h"

/* From the platform: prints a text; ends the emulation. */
void put(const char *text);
void leave(uint32_t code);

/* Tolerance level of the unit, and how many periods it runs for. */
#define LEVEL 2.5f
#define PERIODS 200
/* Forces that the queue has room for, while the task of low priority does other work. */
#define ROOM 8
/* Stacks, in words. A step of the predictor takes about 500 bytes, and what calls it some more. */
#define CONTROL_STACK 512
#define REPORT_STACK 256

static QueueHandle_t forces;

void fail(const char *what) {
    put(what);
    put("\n");
    leave(1);
}

void vApplicationStackOverflowHook(TaskHandle_t task, char *name) {
    (void)task;
    fail(name);
}

/* Once a period. The predictor belongs to this task alone, so that it is stepped without a lock. */
static void control(void *predictor) {
    TickType_t woken = xTaskGetTickCount();
    for (int i = 0; i < PERIODS; i++) {
        slipfit_prediction now;
        /* From one instant to the next, not from the end of the last step: so the period does not drift. */
        vTaskDelayUntil(&woken, pdMS_TO_TICKS(1));
        if (slipfit_predictor_step(predictor) != SLIPFIT_OK || slipfit_predictor_read(predictor, &now) != SLIPFIT_OK) {
            fail("the predictor cannot be stepped");
        }
        if (xQueueSend(forces, &now.force, 0) != pdPASS) {
            fail("the other task does not keep up");
        }
    }
    vTaskSuspend(NULL);
}

/* What the product does with forces: here a hash (FNV-1a) of their bits, by which a test compares them with those of the PC. */
static void report(void *unused) {
    (void)unused;
    uint64_t hash = 0xcbf29ce484222325ull;
    for (int i = 0; i < PERIODS; i++) {
        union {
            float force;
            uint8_t bytes[4];
        } found;
        xQueueReceive(forces, &found.force, portMAX_DELAY);
        for (int byte = 0; byte < 4; byte++) {
            hash = (hash ^ found.bytes[byte]) * 0x100000001b3ull;
        }
    }
    char text[] = "forces ................\n";
    for (int i = 0; i < 16; i++) {
        text[7 + i] = "0123456789abcdef"[hash >> (60 - 4 * i) & 15u];
    }
    put(text);
    leave(0);
}

int main(void) {
    static slipfit_predictor predictor;
    static StaticQueue_t queue;
    static uint8_t room[ROOM * sizeof(float)];
    static StaticTask_t control_task, report_task;
    static StackType_t control_stack[CONTROL_STACK], report_stack[REPORT_STACK];

    /* It says whether the scene suits the library, so ask before the drive starts. It takes as long as 150 steps. */
    if (slipfit_predictor_init(&predictor, &slipfit_this_scene, LEVEL) != SLIPFIT_OK) {
        fail("the scene is refused");
    }
    forces = xQueueCreateStatic(ROOM, sizeof(float), room, &queue);
    xTaskCreateStatic(control, "control", CONTROL_STACK, &predictor, 2, control_stack, &control_task);
    xTaskCreateStatic(report, "report", REPORT_STACK, NULL, 1, report_stack, &report_task);
    vTaskStartScheduler();
    return 1;
}
