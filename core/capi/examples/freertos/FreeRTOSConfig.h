/* FreeRTOS on the emulated Cortex-M4F: ticks of 1 ms, tasks and queues in static memory. */
#ifndef FREERTOS_CONFIG_H
#define FREERTOS_CONFIG_H

/* Processor clock of the emulated board (Hz), and ticks in a second: the control period is one tick. */
#define configCPU_CLOCK_HZ 25000000
#define configTICK_RATE_HZ 1000
#define configTICK_TYPE_WIDTH_IN_BITS TICK_TYPE_WIDTH_32_BITS

#define configUSE_PREEMPTION 1
#define configMAX_PRIORITIES 3
#define configUSE_IDLE_HOOK 0
#define configUSE_TICK_HOOK 0
#define configUSE_TIMERS 0
#define INCLUDE_vTaskDelayUntil 1
#define INCLUDE_vTaskSuspend 1

/* No heap. */
#define configSUPPORT_STATIC_ALLOCATION 1
#define configSUPPORT_DYNAMIC_ALLOCATION 0
#define configKERNEL_PROVIDED_STATIC_MEMORY 1
/* Words of stack of the idle task. */
#define configMINIMAL_STACK_SIZE 128
#define configCHECK_FOR_STACK_OVERFLOW 2

/* Interrupts that call FreeRTOS have the priority 5 or a lower one; 0 is the highest, 15 the lowest, in the upper four bits. */
#define configMAX_SYSCALL_INTERRUPT_PRIORITY (5 << 4)
#define configKERNEL_INTERRUPT_PRIORITY (15 << 4)

/* The vectors of the start-up code have CMSIS's names. */
#define vPortSVCHandler SVC_Handler
#define xPortPendSVHandler PendSV_Handler
#define xPortSysTickHandler SysTick_Handler

/* In main.c: says what went wrong, and ends the program. */
void fail(const char *what);
#define configASSERT(condition) \
    if (!(condition)) {         \
        fail(#condition);       \
    }

#endif
