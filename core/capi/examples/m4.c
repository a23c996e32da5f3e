/* A Cortex-M4F under a debugger as the program's platform: reset handler, vectors, semihosting. */
#include <stddef.h>
#include <stdint.h>

extern uint32_t _data_start, _data_end, _data_load, _bss_start, _bss_end, _stack_top;

int main(void);
void put(const char *text);
void leave(uint32_t code);
void reset(void);

static uint32_t semihosting(uint32_t operation, const void *argument) {
    register uint32_t r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

/* To the debugger's standard output: SYS_OPEN of ":tt" for writing, then SYS_WRITE. */
void put(const char *text) {
    static uint32_t output;
    if (output == 0) {
        const struct {
            const char *name;
            uint32_t mode, length;
        } console = {":tt", 4, 3};
        output = semihosting(0x01, &console);
    }
    uint32_t length = 0;
    while (text[length] != 0) {
        length++;
    }
    const struct {
        uint32_t file;
        const char *text;
        uint32_t length;
    } written = {output, text, length};
    semihosting(0x05, &written);
}

/* Ends the emulation. */
void leave(uint32_t code) {
    const uint32_t block[2] = {0x20026, code};
    semihosting(0x20, block);
    for (;;) {
    }
}

/* A fault must end the program, not hang it. */
static void fault(void) {
    put("fault\n");
    leave(1);
}

/* What an operating system defines, by CMSIS's names. */
void SVC_Handler(void) __attribute__((weak, alias("fault")));
void PendSV_Handler(void) __attribute__((weak, alias("fault")));
void SysTick_Handler(void) __attribute__((weak, alias("fault")));

/* The compiler may turn loops into calls of these. */
void *memcpy(void *to, const void *from, size_t length) {
    uint8_t *t = to;
    for (const uint8_t *f = from; length > 0; length--) {
        *t++ = *f++;
    }
    return to;
}

void *memset(void *to, int value, size_t length) {
    for (uint8_t *t = to; length > 0; length--) {
        *t++ = (uint8_t)value;
    }
    return to;
}

static void run(void) {
    uint32_t *from = &_data_load;
    for (uint32_t *to = &_data_start; to < &_data_end;) {
        *to++ = *from++;
    }
    for (uint32_t *to = &_bss_start; to < &_bss_end;) {
        *to++ = 0;
    }
    leave((uint32_t)main());
}

/* The FPU first (CPACR): compiled code may use it at once. */
__attribute__((naked, noreturn)) void reset(void) {
    __asm__ volatile(
        "ldr r0, =0xe000ed88\n"
        "ldr r1, [r0]\n"
        "orr r1, r1, #0xf00000\n"
        "str r1, [r0]\n"
        "dsb\n"
        "isb\n"
        "b %0\n"
        :
        : "i"(run));
}

/* What the processor reads at address 0. */
union vector {
    uint32_t *stack;
    void (*handler)(void);
};

__attribute__((section(".vectors"), used)) static const union vector vectors[16] = {
    {.stack = &_stack_top},
    {.handler = reset},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    {.handler = fault},
    [11] = {.handler = SVC_Handler},
    [14] = {.handler = PendSV_Handler},
    [15] = {.handler = SysTick_Handler},
};
