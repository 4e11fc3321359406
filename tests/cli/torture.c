/* `weft capture` is killed again and again in the midst of one session: torture PROGRAM ASSETS [KILLS]. Nothing that it
 * had taken may be lost, repeated or wrong. The photographs are held against those of a session that ran undisturbed,
 * with a rig whose arms do not err, so that a photograph of another pose would be seen. */
#include "base/picture/image.h"
#include "capture/session_check.h"

#include <dirent.h>
#include <fcntl.h>
#include <limits.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { SIZE = 96, BLOCK = 6, LIGHTS = 10 };

static const char *program, *sample;
static int shot_count;

static void fail(const char *what)
{
    fprintf(stderr, "torture: %s\n", what);
    exit(1);
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- One session ---- */

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    if (!file || fputs(text, file) < 0 || fclose(file) != 0)
        fail(path);
}

static void write_plan(void)
{
    FILE *file = fopen("plan.csv", "w");
    if (!file)
        fail("plan.csv");
    fputs("theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n", file);
    for (int i = 0; i < shot_count; i++) {
        int light = i % LIGHTS, view = i / LIGHTS;
        fprintf(file, "%d,%d,%d,%d\n", 9 * light, 37 * light % 360, 15 + view % 7 * 9, view * 5 % 360);
    }
    fclose(file);
}

static pid_t start(const char *folder)
{
    pid_t child = fork();
    if (child == 0) {
        int nothing = open("/dev/null", O_WRONLY);
        dup2(nothing, STDOUT_FILENO);
        execl(program, "weft", "capture", "--rig", "rig.json", "--sample", sample, "--plan", "plan.csv", "--truth-size",
              "4", "--truth-images", "3", "-q", "-o", folder, (char *)NULL);
        _exit(127);
    }
    if (child < 0)
        fail("cannot start a process");
    return child;
}

static void complete(const char *folder)
{
    int status;
    if (waitpid(start(folder), &status, 0) < 0 || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail("a capture that nobody disturbed failed");
}

static int journal_lines(void)
{
    FILE *file = fopen("session/journal.jsonl", "r");
    int lines = 0;
    for (int c; file && (c = getc(file)) != EOF;)
        lines += c == '\n';
    if (file)
        fclose(file);
    return lines;
}

/* ---- Killing ---- */

static double seconds_to_the_first, seconds_a_shot;

/* How long a capture takes to its first photograph, and from one to the next. */
static void measure(void)
{
    double start_s = now_s(), first_s = 0;
    int status;
    pid_t child = start("reference");
    while (waitpid(child, &status, WNOHANG) == 0) {
        if (first_s == 0 && access("reference/journal.jsonl", F_OK) == 0)
            first_s = now_s() - start_s;
        usleep(500);
    }
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        fail("a capture that nobody disturbed failed");
    seconds_to_the_first = first_s;
    seconds_a_shot = (now_s() - start_s - first_s) / (shot_count - 1);
}

static double chance(void)
{
    return rand() / (RAND_MAX + 1.0);
}

/* Anywhere from the first instruction to the fourth photograph. Whether it was still running. */
static bool kill_somewhere(pid_t child)
{
    int before = journal_lines(), more = rand() % 2, status;
    if (more == 0)
        usleep((useconds_t)(1e6 * chance() * seconds_to_the_first));
    while (more > 0 && journal_lines() < before + more && waitpid(child, &status, WNOHANG) == 0)
        usleep(100);
    usleep((useconds_t)(1e6 * chance() * 3 * seconds_a_shot));
    kill(child, SIGKILL);
    return waitpid(child, &status, 0) > 0 && WIFSIGNALED(status);
}

/* ---- What was left ---- */

typedef struct tally {
    int kills, lost, journal_errors, in_flight, most_in_flight, faults, wrong, left_over;
} tally;

static int count_photographs(const weft_session *session)
{
    int count = 0;
    for (int shot = 0; shot < session->shot_count; shot++) {
        char path[PATH_MAX];
        weft_session_photograph_path(session, shot, path, sizeof path);
        count += access(path, F_OK) == 0;
    }
    return count;
}

/* Whatever the journal named before, it names still, in the same words. */
static void compare_with_before(const weft_session *session, weft_shot_record *before, tally *t)
{
    int taken = 0;
    for (int shot = 0; shot < session->shot_count; shot++) {
        const weft_shot_record *now = &session->record[shot];
        t->lost += before[shot].taken && !(now->taken && now->line == before[shot].line);
        taken += now->taken;
        before[shot] = *now;
    }
    t->journal_errors += taken != journal_lines();
    int in_flight = count_photographs(session) - taken;
    t->in_flight += in_flight;
    if (in_flight > t->most_in_flight)
        t->most_in_flight = in_flight;
}

static void look_after_kill(weft_shot_record *before, tally *t)
{
    weft_session session;
    if (access("session/session.json", F_OK) != 0)
        return;
    if (weft_session_open("session", &session, NULL) != WEFT_OK) {
        t->journal_errors++;
        return;
    }
    compare_with_before(&session, before, t);
    weft_session_free(&session);
}

/* Hidden files are what is left of a file that was never renamed; the lock stays. */
static int count_left_over(const char *folder)
{
    int count = 0;
    DIR *listing = opendir(folder);
    for (struct dirent *entry; listing && (entry = readdir(listing));) {
        const char *name = entry->d_name;
        count += name[0] == '.' && strcmp(name, ".") != 0 && strcmp(name, "..") != 0 && strcmp(name, ".lock") != 0;
    }
    if (listing)
        closedir(listing);
    return count;
}

/* ---- Against the undisturbed session ---- */

static void read_radiance(const weft_session *session, int shot, float *radiance)
{
    static uint16_t samples[SIZE * SIZE * 3];
    char path[PATH_MAX];
    weft_session_photograph_path(session, shot, path, sizeof path);
    if (weft_photograph_read(path, SIZE, SIZE, session->bits, samples, NULL) != WEFT_OK)
        fail(path);
    for (int i = 0; i < SIZE * SIZE * 3; i++)
        radiance[i] = (float)((samples[i] - session->black_level) / session->record[shot].exposure_s);
}

static double block_of(const float *radiance, int x0, int y0)
{
    double sum = 0;
    for (int y = y0; y < y0 + BLOCK; y++) {
        for (int i = 3 * (y * SIZE + x0); i < 3 * (y * SIZE + x0 + BLOCK); i++)
            sum += (double)radiance[i];
    }
    return sum;
}

/* Mean difference of squares of BLOCK x BLOCK pixels, relative to the mean: noise is lost in squares, another pose is
 * not. */
static double difference(const weft_session *a, int shot, const weft_session *b, int other)
{
    static float first[SIZE * SIZE * 3], second[SIZE * SIZE * 3];
    double sum = 0, whole = 0;
    read_radiance(a, shot, first);
    read_radiance(b, other, second);
    for (int y = 0; y < SIZE; y += BLOCK) {
        for (int x = 0; x < SIZE; x += BLOCK) {
            double theirs = block_of(second, x, y);
            sum += fabs(block_of(first, x, y) - theirs);
            whole += theirs;
        }
    }
    return sum / whole;
}

static void compare_with_reference(tally *t)
{
    const double noise = 0.005;
    weft_session session, reference;
    weft_session_problems faults;
    double worst = 0, nearest_other = INFINITY;
    if (weft_session_open("session", &session, NULL) != WEFT_OK ||
        weft_session_open("reference", &reference, NULL) != WEFT_OK ||
        weft_session_check(&session, NULL, &faults, NULL) != WEFT_OK)
        fail("the session cannot be opened");
    for (int i = 0; i < faults.count; i++)
        fprintf(stderr, "%s\n", faults.problem[i].text);
    t->faults = faults.count + shot_count - journal_lines();
    for (int shot = 0; shot < shot_count && faults.count == 0; shot++) {
        double own = difference(&session, shot, &reference, shot);
        worst = fmax(worst, own);
        nearest_other = fmin(nearest_other, difference(&session, shot, &reference, (shot + 1) % shot_count));
        t->wrong += own > noise;
        if (own > noise)
            fprintf(stderr, "shot %d differs by %.4f\n", shot, own);
    }
    printf("photographs differ from those of the undisturbed session by %.4f at most, from the next shot's by %.4f at "
           "least\n",
           worst, nearest_other);
    if (nearest_other < 2 * noise)
        fail("the comparison could not tell a photograph of another pose");
    weft_session_problems_free(&faults);
    weft_session_free(&reference);
    weft_session_free(&session);
}

/* ---- The whole ---- */

static tally torture(int kills)
{
    tally t = {0};
    weft_shot_record *before = calloc((size_t)shot_count, sizeof *before);
    if (!before)
        fail("no memory");
    while (t.kills < kills && journal_lines() < shot_count) {
        t.kills += kill_somewhere(start("session"));
        look_after_kill(before, &t);
    }
    complete("session");
    look_after_kill(before, &t);
    t.left_over = count_left_over("session") + count_left_over(".");
    free(before);
    compare_with_reference(&t);
    return t;
}

static void enter_scratch_folder(char folder[])
{
    if (!mkdtemp(folder) || chdir(folder) != 0)
        fail("no scratch folder");
    write_plan();
    write_text("rig.json", "{\"rig\":\"virtual\",\"width_px\":96,\"height_px\":96,\"focal_length_px\":440,"
                           "\"samples_per_pixel\":2,\"viewpoint_rotation_deg\":0,\"viewpoint_translation_mm\":0,"
                           "\"light_rotation_deg\":0,\"light_power_drift\":0}");
}

/* What failed stays, to be looked at. */
static void leave(const char *folder, bool survived)
{
    char command[64];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    if (!survived)
        fprintf(stderr, "torture: left in %s\n", folder);
    else if (chdir("/") != 0 || system(command) != 0)
        fail("cannot remove the scratch folder");
}

int main(int argc, char **argv)
{
    char folder[] = "/tmp/weft-torture-XXXXXX", assets[PATH_MAX];
    if (argc < 3)
        fail("usage: torture PROGRAM ASSETS [KILLS]");
    int kills = argc > 3 ? atoi(argv[3]) : 30;
    program = realpath(argv[1], NULL);
    snprintf(assets, sizeof assets, "%s/weaves/polyester_lining.wv", argv[2]);
    sample = realpath(assets, NULL);
    if (!program || !sample)
        fail("no such program or weave");
    shot_count = LIGHTS * (2 + 4 * kills / LIGHTS);
    enter_scratch_folder(folder);
    srand(20240607);
    measure();
    tally t = torture(kills);
    printf(
        "%d photographs, %d kills: %d lost, %d wrong, %d faults, %d journal errors, %d taken without a line (at most "
        "%d at once), %d files left over\n",
        shot_count, t.kills, t.lost, t.wrong, t.faults, t.journal_errors, t.in_flight, t.most_in_flight, t.left_over);
    /* A machine that is busy while the session is timed, and idle afterwards, is through with it before all kills. */
    bool survived = t.kills >= (kills + 3) / 4 && t.lost + t.wrong + t.faults + t.journal_errors + t.left_over == 0 &&
                    t.most_in_flight <= 1;
    leave(folder, survived);
    return survived ? 0 : 1;
}
