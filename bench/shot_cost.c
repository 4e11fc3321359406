/* What a shot costs beyond camera and stage: metering, file, checksum, journal and the waits for the disk. The stage
 * costs nothing here, the camera WAIT_MS for each photograph; its time is taken off. Files are written while the camera
 * takes the next photograph, so a camera that takes no time shows what that costs. Usage: bench_shot_cost FOLDER
 * [WAIT_MS [SIDE [SHOTS]]]; the session FOLDER must not exist. */
#include "base/clock.h"
#include "base/picture/image.h"
#include "capture/capture.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

enum { LIGHTS = 81, BITS = 12, LEVEL = 2600 };

typedef struct idle {
    uint16_t *photograph; /* [side][side][3] */
    size_t count;
    weft_angles view;
    bool placed;
    double wait_s, spent_s; /* of a photograph; in all of them */
} idle;

static weft_code home(void *device, int first_viewpoint, weft_error *error)
{
    (void)device, (void)first_viewpoint, (void)error;
    return WEFT_OK;
}

static weft_code move(void *device, weft_angles view, weft_angles light, bool *moved, weft_error *error)
{
    idle *i = device;
    (void)light, (void)error;
    *moved = !i->placed || view.theta_rad != i->view.theta_rad || view.phi_rad != i->view.phi_rad;
    i->view = view;
    i->placed = true;
    return WEFT_OK;
}

static weft_code power(void *device, bool on, weft_error *error)
{
    (void)device, (void)on, (void)error;
    return WEFT_OK;
}

/* No two photographs are alike. */
static weft_code expose(void *device, uint64_t frame, double exposure_s, uint16_t *samples, double *read_back_s,
                        weft_error *error)
{
    idle *i = device;
    double start_s = weft_now_s();
    const struct timespec wait = {0, (long)(i->wait_s * 1e9)};
    (void)error;
    nanosleep(&wait, NULL);
    memcpy(samples, i->photograph, i->count * sizeof *samples);
    for (int k = 0; k < 3; k++)
        samples[k] = (uint16_t)(frame >> 11 * k & 0x7ff);
    *read_back_s = exposure_s;
    i->spent_s += weft_now_s() - start_s;
    return WEFT_OK;
}

static bool write_plan(const char *path, int shots)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    fputs("theta_light_deg,phi_light_deg,theta_view_deg,phi_view_deg\n", file);
    for (int i = 0; i < shots; i++)
        fprintf(file, "%d,%d,%d,%d\n", 15 + i % LIGHTS / 9 * 7, i % 9 * 40, 5 * (i / LIGHTS % 15),
                24 * (i / LIGHTS / 15));
    return fclose(file) == 0;
}

static double processor_s(void)
{
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    return (double)use.ru_utime.tv_sec + (double)use.ru_stime.tv_sec +
           1e-6 * (double)(use.ru_utime.tv_usec + use.ru_stime.tv_usec);
}

static weft_rig rig_of(idle *devices, int side)
{
    weft_rig rig = {.name = "idle",
                    .sample = "nothing",
                    .identity = "{}",
                    .settings = weft_rig_settings_default(),
                    .camera = {.device = devices, .expose = expose},
                    .stage = {.device = devices, .home = home, .move = move},
                    .light = {devices, power}};
    rig.settings.width_px = rig.settings.height_px = side;
    rig.settings.focal_length_px = 1920.0 * side / 416;
    rig.settings.bits = BITS;
    rig.calibration = weft_rig_settings_camera(&rig.settings);
    return rig;
}

/* The library that writes pictures takes a third of a second to load, once. */
static weft_code warm_up(const char *path, const uint16_t *photograph, weft_error *error)
{
    WEFT_TRY(weft_photograph_write(path, 32, 32, BITS, photograph, error));
    remove(path);
    return WEFT_OK;
}

static weft_code run(const weft_capture_request *request, weft_rig *rig, int shots, weft_error *error)
{
    const idle *devices = rig->camera.device;
    weft_capture capture;
    WEFT_TRY(weft_capture_begin(request, rig, NULL, &capture, error));
    double start_s = weft_now_s(), used_s = processor_s();
    weft_code code = weft_capture_take(&capture, NULL, NULL, error);
    if (code == WEFT_OK)
        printf("%d shots of %d x %d by a camera that takes %.1f ms: %.2f ms each beyond it, %.2f ms of processors\n",
               shots, rig->calibration.width, rig->calibration.height, 1e3 * devices->spent_s / shots,
               1e3 * (weft_now_s() - start_s - devices->spent_s) / shots, 1e3 * (processor_s() - used_s) / shots);
    weft_capture_end(&capture);
    return code;
}

int main(int argc, char **argv)
{
    int wait_ms = argc > 2 ? atoi(argv[2]) : 50, side = argc > 3 ? atoi(argv[3]) : 416;
    int shots = argc > 4 ? atoi(argv[4]) : 5 * LIGHTS;
    char plan[4096];
    weft_error error = {0};
    if (argc < 2 || wait_ms < 0 || wait_ms > 999 || side < 64 || side > 8192 || shots < 1) {
        fputs("usage: bench_shot_cost FOLDER [WAIT_MS [SIDE [SHOTS]]]\n", stderr);
        return 2;
    }
    snprintf(plan, sizeof plan, "%.4000s.plan.csv", argv[1]);
    idle devices = {.count = (size_t)side * (size_t)side * 3, .wait_s = 1e-3 * wait_ms};
    devices.photograph = malloc(devices.count * sizeof *devices.photograph);
    if (!devices.photograph || !write_plan(plan, shots)) {
        free(devices.photograph);
        return 3;
    }
    for (size_t i = 0; i < devices.count; i++)
        devices.photograph[i] = (uint16_t)(LEVEL + i * 2654435761u % 512);
    const weft_capture_request request = {.folder = argv[1], .plan = plan};
    weft_rig rig = rig_of(&devices, side);
    char sample[4096];
    snprintf(sample, sizeof sample, "%.4000s.sample.tif", argv[1]);
    weft_code code = warm_up(sample, devices.photograph, &error);
    if (code == WEFT_OK)
        code = run(&request, &rig, shots, &error);
    if (code != WEFT_OK)
        fprintf(stderr, "bench_shot_cost: %s\n", error.message);
    free(devices.photograph);
    remove(plan);
    return (int)code;
}
