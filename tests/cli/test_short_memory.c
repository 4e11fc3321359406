/* Every command of Weft with an allocation that fails. Each run ends with one line that says so, leaves no half-written
 * file and keeps no memory; one that ends well has written the bytes of the run that nothing disturbed.
 *
 * Usage: test_short_memory inputs                    makes the folder 'inputs', which the jobs read
 *        test_short_memory [--more|--sites|--every] [JOB...] these jobs or subcommands, or all
 * The first allocation of a site fails (short_memory.h), alone: at a few sites spread over the job. With --sites it is
 * every site, and the last allocation of each fails, too, with all that follow it: hours under AddressSanitizer; with
 * --more as many sites as some time allows, spread over the run; with --every the n-th allocation of all alone, n = 1,
 * 2, 3
 * ... until a run ends in which none failed. */
#include "base/picture/image_library.h"
#include "tests/cli/short_memory.h"
#include "tests/cli/short_memory_files.h"
#include "tests/cli/short_memory_jobs.h"

#include <cairo.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#if defined(__SANITIZE_ADDRESS__)
#include <sanitizer/common_interface_defs.h>
#include <sanitizer/lsan_interface.h>
#endif

enum { MAX_SAID = 1 << 16, TIME_LIMIT_S = 120, MOST_FAULTS = 20, SYSTEM_FAILURE = 3, LEAKED = 23, FEW_SITES = 3 };

/* Of processor time that a job may take with --more, about. */
static const double more_s = 30;

int __real_main(int argc, char **argv);
int __wrap_main(int argc, char **argv);
int __real_pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *), void *argument);

typedef struct outcome {
    int status;          /* as waitpid gives it */
    char said[MAX_SAID]; /* on standard error */
    char printed[MAX_SAID];
    file_list files;
} outcome;

static short_memory_log *memory_log; /* shared with the runs */
static int runs, faults;
static char run_folder[32]; /* of this process: others may run beside it */

static const short_memory_order undisturbed;

typedef enum extent { FIRST, MORE, SITES, EVERY } extent;

/* ---- One run, in a process of its own ---- */

/* Not by exit(): libraries that started threads when they were loaded wait there for what no fork has. */
static void leave(int code)
{
    fflush(NULL);
#if defined(__SANITIZE_ADDRESS__)
    if (__lsan_do_recoverable_leak_check() != 0)
        code = LEAKED;
#endif
    _exit(code);
}

/* argp ends the program by itself where a value cannot be kept. */
static void leave_early(int code, void *context)
{
    (void)context;
    leave(code);
}

static void *call_main(void *context)
{
    const short_memory_job *job = context;
    char *argument[SHORT_MEMORY_ARGUMENTS + 5] = {"weft"};
    int count = 1;
    while (job->argument[count - 1])
        argument[count] = (char *)job->argument[count - 1], count++;
    if (job->way != PRINTS)
        argument[count++] = "--quiet";
    argument[count++] = "--threads=2";
    int code = __real_main(count, argument);
    cairo_debug_reset_static_data(); /* it keeps typefaces for later pages, and is no leak */
    short_memory_count_kept();
    leave(code);
    return NULL;
}

/* On a thread, so that nothing of this program stands below what is called and a site is the same from wherever a run
 * is begun. */
static void run_in_child(const short_memory_job *job, const char *folder, short_memory_order order)
{
    pthread_t thread;
    if (chdir(folder) != 0)
        abort();
    alarm(TIME_LIMIT_S);
    on_exit(leave_early, NULL);
    short_memory_begin(memory_log, order);
    if (__real_pthread_create(&thread, NULL, call_main, (void *)job) == 0)
        pthread_join(thread, NULL);
    abort();
}

static void read_back(int descriptor, char text[MAX_SAID])
{
    ssize_t size = pread(descriptor, text, MAX_SAID - 1, 0);
    text[size > 0 ? size : 0] = '\0';
    close(descriptor);
}

static void run(const short_memory_job *job, const char *folder, short_memory_order order, outcome *got)
{
    memset(memory_log, 0, sizeof *memory_log);
    int said = memfd_create("said", 0), printed = memfd_create("printed", 0);
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
#if defined(__SANITIZE_ADDRESS__)
        __sanitizer_set_report_fd((void *)(intptr_t)dup(STDERR_FILENO)); /* not into what the program says */
#endif
        dup2(said, STDERR_FILENO);
        dup2(printed, STDOUT_FILENO);
        run_in_child(job, folder, order);
    }
    if (child < 0 || waitpid(child, &got->status, 0) != child)
        abort();
    read_back(said, got->said);
    read_back(printed, got->printed);
    files_list(folder, &got->files);
    runs++;
}

/* ---- What a run must be ---- */

static void fault(const short_memory_job *job, const outcome *got, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void print_frames(const char *what, const uint32_t *frame, int count)
{
    printf("    %s: addr2line -fpe test_short_memory", what);
    for (int i = 0; i < count && frame[i]; i++)
        printf(" 0x%x", frame[i] - 1);
    putchar('\n');
}

static void fault(const short_memory_job *job, const outcome *got, const char *format, ...)
{
    printf("FAILED: %s: ", job->name);
    va_list arguments;
    va_start(arguments, format);
    vprintf(format, arguments);
    va_end(arguments);
    printf("; status 0x%x, said: %s\n", (unsigned)got->status, got->said[0] ? got->said : "nothing");
    faults++;
}

/* Progress may stand before it where a command is not quiet. */
static bool ends_with_one_line(const char *said, const short_memory_job *job)
{
    char start[64];
    snprintf(start, sizeof start, "weft %s: ", job->argument[0]);
    const char *line = strstr(said, start), *end = line ? strchr(line, '\n') : NULL;
    return line && (line == said || job->way == PRINTS) && end && end[1] == '\0';
}

static bool says_what_is_short(const char *said)
{
    return strstr(said, "memory") || strstr(said, "thread");
}

static bool may_go_on_from(const short_memory_job *job, const char *name)
{
    return job->way == GOES_ON && (strstr(name, ".partial") || strstr(name, "journal") || strstr(name, ".lock"));
}

/* A comparison that has no OpenGL has no pictures of the drape, and says on its page why not. */
static bool page_tells(void)
{
    char path[64], text[MAX_SAID];
    snprintf(path, sizeof path, "%s/report/index.html", run_folder);
    int page = open(path, O_RDONLY);
    if (page < 0)
        return false;
    read_back(page, text);
    return strstr(text, "out of memory") != NULL;
}

/* Returns whether the run is as it must be. */
static bool check(const short_memory_job *job, const outcome *got, const outcome *whole)
{
    int before = faults;
    bool fails = got->status != 0, is_told = !fails && page_tells();
    if (!WIFEXITED(got->status))
        fault(job, got, "%s", WTERMSIG(got->status) == SIGALRM ? "hung" : "crashed");
    else if (memory_log->kept > 0)
        fault(job, got, "%ld blocks of memory were kept", memory_log->kept);
    const struct listed_file *strange = files_first_strange(&got->files, &whole->files);
    if (strange && !is_told && !may_go_on_from(job, strange->name))
        fault(job, got, "'%s' is not what the run that nothing disturbed writes", strange->name);
    if (!fails) {
        if ((!is_told && got->files.count != whole->files.count) ||
            (job->way == PRINTS && strcmp(got->printed, whole->printed) != 0))
            fault(job, got, "ended well with another result");
    } else if (WIFEXITED(got->status)) {
        if (WEXITSTATUS(got->status) != SYSTEM_FAILURE || !ends_with_one_line(got->said, job) ||
            !says_what_is_short(got->said))
            fault(job, got, "no clear line");
    }
    return faults == before;
}

/* ---- Jobs ---- */

static void try(const short_memory_job *job, short_memory_order order, const short_memory_site *site, outcome *got,
                const outcome *whole)
{
    files_make_empty(run_folder);
    run(job, run_folder, order, got);
    if (check(job, got, whole))
        return;
    printf("    allocation %ld%s\n", order.number, order.from_then ? " and all that follow" : "");
    if (site)
        print_frames("asked for at", site->frame, SHORT_MEMORY_FRAMES);
    if (memory_log->kept > 0)
        print_frames("kept", memory_log->keeper, 4);
}

static int count_sites(const short_memory_log *noted)
{
    int count = 0;
    for (int i = 0; i < SHORT_MEMORY_SITES; i++)
        count += noted->site[i].hash != 0;
    return count;
}

/* Every how many sites one is tried; a run that fails takes at most as long as one that does not. */
static int choose_stride(const short_memory_log *noted, extent reach, double once_s)
{
    int sites = count_sites(noted);
    if (reach == MORE)
        return 1 + (int)(2 * sites * once_s / more_s);
    return reach == FIRST ? 1 + sites / FEW_SITES : 1;
}

static void try_sites(const short_memory_job *job, const outcome *whole, extent reach, double once_s)
{
    static short_memory_log noted;
    static outcome got;
    memcpy(&noted, memory_log, sizeof noted);
    int sites = 0, before = runs, stride = choose_stride(&noted, reach, once_s);
    for (int i = 0; i < SHORT_MEMORY_SITES && faults < MOST_FAULTS; i++) {
        const short_memory_site *site = &noted.site[i];
        if (site->hash == 0 || sites++ % stride != 0)
            continue;
        try(job, (short_memory_order){site->hash, 1, false}, site, &got, whole);
        if (reach != FIRST)
            try(job, (short_memory_order){site->hash, site->count, true}, site, &got, whole);
    }
    printf("%s: %ld allocations at %d sites, %d runs", job->name, noted.count, sites, runs - before);
}

static void try_every(const short_memory_job *job, const outcome *whole)
{
    static outcome got;
    long count = memory_log->count, number = 0;
    do {
        try(job, (short_memory_order){0, ++number, false}, NULL, &got, whole);
    } while (memory_log->failed > 0 && faults < MOST_FAULTS);
    printf("%s: %ld allocations, each", job->name, count);
}

/* Processor time of the runs so far. */
static double processor_s(void)
{
    struct rusage usage;
    getrusage(RUSAGE_CHILDREN, &usage);
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

static void run_job(const short_memory_job *job, extent reach)
{
    static outcome whole;
    double start_s = processor_s();
    files_make_empty(run_folder);
    run(job, run_folder, undisturbed, &whole);
    double once_s = processor_s() - start_s;
    if (whole.status != 0 || memory_log->kept > 0) {
        fault(job, &whole, "%s", whole.status != 0 ? "fails undisturbed" : "keeps memory undisturbed");
        print_frames("kept", memory_log->keeper, 4);
    } else if (reach == EVERY)
        try_every(job, &whole);
    else
        try_sites(job, &whole, reach, once_s);
    printf(", %.3f s of processor once, %.1f s in all\n", once_s, processor_s() - start_s);
}

/* The module is linked here: its allocations fail, too. */
weft_code __wrap_weft_image_library_open(const weft_image_library **library, weft_error *error);
weft_code __wrap_weft_image_library_open(const weft_image_library **library, weft_error *error)
{
    (void)error;
    *library = &weft_image_library_table;
    return WEFT_OK;
}

static void make_inputs(void)
{
    static outcome got;
    files_make_empty("inputs");
    if (chdir("inputs") != 0)
        abort();
    pid_t child = fork();
    if (child == 0) {
        short_memory_write_inputs();
        leave(0);
    }
    if (child < 0 || waitpid(child, &got.status, 0) != child || got.status != 0)
        abort();
    for (const short_memory_job *job = short_memory_inputs; job->name; job++) {
        run(job, ".", undisturbed, &got);
        if (got.status != 0)
            fault(job, &got, "fails");
    }
}

/* By its name, or by its subcommand. */
static bool is_chosen(const short_memory_job *job, int count, char **chosen)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(chosen[i], job->name) == 0 || strcmp(chosen[i], job->argument[0]) == 0)
            return true;
    }
    return count == 0;
}

int __wrap_main(int argc, char **argv)
{
    const char *option = argc > 1 ? argv[1] : "";
    extent reach = strcmp(option, "--every") == 0   ? EVERY
                   : strcmp(option, "--sites") == 0 ? SITES
                   : strcmp(option, "--more") == 0  ? MORE
                                                    : FIRST;
    int first = reach == FIRST ? 1 : 2;
    memory_log = mmap(NULL, sizeof *memory_log, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory_log == MAP_FAILED)
        abort();
    short_memory_prepare();
    setvbuf(stdout, NULL, _IOLBF, 0);
    if (argc == 2 && strcmp(argv[1], "inputs") == 0)
        make_inputs();
    else {
        snprintf(run_folder, sizeof run_folder, "run-%ld", (long)getpid());
        for (const short_memory_job *job = short_memory_jobs; job->name; job++) {
            if (is_chosen(job, argc - first, argv + first))
                run_job(job, reach);
        }
        files_remove(run_folder);
    }
    printf("%d runs, %d faults\n", runs, faults);
    return faults > 0 || runs == 0;
}
