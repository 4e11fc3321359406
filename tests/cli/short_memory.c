#include "tests/cli/short_memory.h"

#include <dirent.h>
#include <errno.h>
#include <execinfo.h>
#include <jansson.h>
#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Of the program, from the linker. */
extern const char __executable_start[], etext[];

static struct {
    short_memory_log *log; /* NULL: nothing is noted */
    short_memory_order order;
    atomic_bool all_fail;
} memory;

/* ---- Sites ---- */

enum { STACK_DEPTH = 48 };

static bool is_ours(const void *address)
{
    return (const char *)address >= __executable_start && (const char *)address < etext;
}

/* The innermost stretch of Weft's own frames from `caller` on: threads, and libraries that call back, differ below it.
 */
static int own_frames(const void *caller, uint32_t frame[SHORT_MEMORY_FRAMES])
{
    void *stack[STACK_DEPTH];
    int depth = backtrace(stack, STACK_DEPTH), first = 0, count = 0;
    while (first < depth && stack[first] != caller)
        first++;
    while (first < depth && !is_ours(stack[first]))
        first++;
    for (int i = first; i < depth && count < SHORT_MEMORY_FRAMES && is_ours(stack[i]); i++)
        frame[count++] = (uint32_t)((const char *)stack[i] - __executable_start);
    return count;
}

static uint64_t hash_of(const uint32_t *frame, int count)
{
    uint64_t hash = 0xcbf29ce484222325;
    for (int i = 0; i < count; i++)
        hash = (hash ^ frame[i]) * 0x100000001b3;
    return hash ? hash : 1;
}

/* Counts the allocation at its site. Returns the hash of that, and the allocation's number there in *number. */
static uint64_t note_site(const void *caller, long *number)
{
    uint32_t frame[SHORT_MEMORY_FRAMES] = {0};
    uint64_t hash = hash_of(frame, own_frames(caller, frame)), found;
    short_memory_site *site = memory.log->site + hash % SHORT_MEMORY_SITES;
    for (;;) {
        found = 0;
        if (atomic_compare_exchange_strong(&site->hash, &found, hash))
            memcpy(site->frame, frame, sizeof frame);
        if (found == 0 || found == hash)
            break;
        site = site == memory.log->site + SHORT_MEMORY_SITES - 1 ? memory.log->site : site + 1;
    }
    *number = atomic_fetch_add(&site->count, 1) + 1;
    return hash;
}

static bool is_ordered(const void *caller, long number_of_all)
{
    const short_memory_order *order = &memory.order;
    if (order->number > 0 && order->site == 0)
        return number_of_all == order->number;
    long number;
    uint64_t site = note_site(caller, &number);
    return order->number == number && order->site == site;
}

bool short_memory_fails(const void *caller)
{
    short_memory_log *log = memory.log;
    if (!log)
        return false;
    long number = atomic_fetch_add(&log->count, 1) + 1;
    bool fails = atomic_load(&memory.all_fail);
    /* It happens once: nothing is looked for afterwards. */
    if (!fails && atomic_load(&log->failed) == 0)
        fails = is_ordered(caller, number);
    if (!fails)
        return false;
    atomic_fetch_add(&log->failed, 1);
    if (memory.order.from_then)
        atomic_store(&memory.all_fail, true);
    errno = ENOMEM;
    return true;
}

/* ---- What is not freed ---- */

enum { KEPT_SLOTS = 1 << 20, KEPT_FRAMES = 4 };

/* A table of what is held now, by open addressing; `gone` marks a slot that was used. */
static struct {
    pthread_mutex_t lock;
    const void *block[KEPT_SLOTS];
    const void *caller[KEPT_SLOTS];
} kept = {.lock = PTHREAD_MUTEX_INITIALIZER};
static const char gone;

static size_t slot_of(const void *block)
{
    return (size_t)(((uintptr_t)block >> 4) * 0x9e3779b97f4a7c15 >> 44) % KEPT_SLOTS;
}

static void *hold(void *block, const void *caller)
{
#if defined(__SANITIZE_ADDRESS__)
    (void)caller;
    return block; /* the table would hide a leak from LeakSanitizer */
#endif
    if (!block || !memory.log)
        return block;
    pthread_mutex_lock(&kept.lock);
    size_t slot = slot_of(block);
    while (kept.block[slot] && kept.block[slot] != &gone)
        slot = (slot + 1) % KEPT_SLOTS;
    kept.block[slot] = block;
    kept.caller[slot] = caller;
    pthread_mutex_unlock(&kept.lock);
    return block;
}

static void let_go(const void *block)
{
    if (!block || !memory.log)
        return;
    pthread_mutex_lock(&kept.lock);
    size_t slot = slot_of(block);
    while (kept.block[slot] && kept.block[slot] != block)
        slot = (slot + 1) % KEPT_SLOTS;
    if (kept.block[slot])
        kept.block[slot] = &gone;
    pthread_mutex_unlock(&kept.lock);
}

void short_memory_count_kept(void)
{
    short_memory_log *log = memory.log;
    memory.log = NULL;
    for (size_t i = 0; i < KEPT_SLOTS; i++) {
        if (!kept.block[i] || kept.block[i] == &gone)
            continue;
        if (log->kept < KEPT_FRAMES)
            log->keeper[log->kept] = (uint32_t)((const char *)kept.caller[i] - __executable_start);
        log->kept++;
    }
}

/* ---- In the place of the allocators ---- */

#define CALLER __builtin_return_address(0)

/* The linker's names: what calls NAME calls __wrap_NAME, and __real_NAME is the NAME of the library. */
#define STAND_IN(type, name, parameters, arguments, failure)                                                           \
    type __real_##name parameters;                                                                                     \
    type __wrap_##name parameters;                                                                                     \
    type __wrap_##name parameters                                                                                      \
    {                                                                                                                  \
        return short_memory_fails(CALLER) ? (failure) : __real_##name arguments;                                       \
    }
#define STAND_IN_HELD(name, parameters, arguments)                                                                     \
    void *__real_##name parameters;                                                                                    \
    void *__wrap_##name parameters;                                                                                    \
    void *__wrap_##name parameters                                                                                     \
    {                                                                                                                  \
        return short_memory_fails(CALLER) ? NULL : hold(__real_##name arguments, CALLER);                              \
    }

STAND_IN_HELD(malloc, (size_t size), (size))
STAND_IN_HELD(calloc, (size_t count, size_t size), (count, size))
STAND_IN_HELD(aligned_alloc, (size_t alignment, size_t size), (alignment, size))
STAND_IN_HELD(strdup, (const char *text), (text))
STAND_IN_HELD(strndup, (const char *text, size_t size), (text, size))
STAND_IN(FILE *, fopen, (const char *path, const char *mode), (path, mode), NULL)
STAND_IN(FILE *, open_memstream, (char **text, size_t *size), (text, size), NULL)
STAND_IN(DIR *, opendir, (const char *path), (path), NULL)
STAND_IN(int, pthread_create,
         (pthread_t * thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument),
         (thread, attributes, start, argument), EAGAIN)

void *__real_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size);
void *__wrap_realloc(void *block, size_t size)
{
    if (short_memory_fails(CALLER))
        return NULL;
    /* Let go first: another thread may be given the old place at once. */
    let_go(block);
    void *moved = __real_realloc(block, size);
    hold(moved ? moved : block, CALLER);
    return moved;
}

void __real_free(void *block);
void __wrap_free(void *block);
void __wrap_free(void *block)
{
    let_go(block);
    __real_free(block);
}

int __wrap_asprintf(char **text, const char *format, ...) __attribute__((format(printf, 2, 3)));
int __wrap_asprintf(char **text, const char *format, ...)
{
    if (short_memory_fails(CALLER))
        return -1;
    va_list arguments;
    va_start(arguments, format);
    int length = vasprintf(text, format, arguments);
    va_end(arguments);
    if (length >= 0)
        hold(*text, CALLER);
    return length;
}

/* ---- Before and after ---- */

void short_memory_prepare(void)
{
    void *stack[2];
    backtrace(stack, 2); /* loads the unwinder, which takes memory itself */
    json_set_alloc_funcs(__wrap_malloc, __wrap_free);
}

void short_memory_begin(short_memory_log *log, short_memory_order order)
{
    memory.log = log;
    memory.order = order;
}
