/* Weft against the models of reflectance transformation imaging, on photographs of one view under lamps that none of
 * them has seen: `bench_rti [FOLDER...] [-- OPTION...]`. A folder holds dirs.lp and its photographs, of which every
 * fifth is held out, or such folders Dome, which is fitted, and Test, which is held out. Without folders those below
 * WEFT_SHARED are taken, and where that is not given one that is made up. The options are those of weft compress.
 *
 * Prints the PSNR of 8-bit sRGB values, the mean over the lamps that are held out, and the relative RMSE of linear
 * values, at pixels that lie spread. PTM and HSH are fitted to the values of the files, as is usual; RBF goes through
 * all photographs; "raw" is Weft's interpolation of the photographs, "weft" what `weft compress` makes of them, on its
 * finest level, with the bytes of its file by the number of pixels and the seconds that it took. */
#include "compare/rti/rti.h"
#include "base/picture/colour.h"
#include "base/picture/image.h"
#include "base/text/light_list.h"
#include "base/vector.h"
#include "bench/measure.h"
#include "weft/evaluate.h"

#include <glob.h>
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum {
    MOST_LAMPS = 1024,
    SIDE = 64,
    EVERY = 5,
    PATH_SIZE = 512,
    MOST_WORDS = 64,
    RAW = WEFT_RTI_MODELS,
    WEFT,
    METHODS
};

static const char *const method_name[METHODS] = {"PTM", "HSH 2", "HSH 3", "RBF", "raw", "weft"};

/* Some lamps, and what is seen under them at the pixels: value [count][pixels][3], sRGB. */
typedef struct lamps {
    int count;
    char *file[MOST_LAMPS];
    weft_vec3 light[MOST_LAMPS];
    float *value;
} lamps;

typedef struct set {
    int width, height, pixel_count;
    double *uv; /* [pixel_count][2] of Weft */
    lamps fitted, held;
    char list[PATH_SIZE], dataset[PATH_SIZE], material[PATH_SIZE];
} set;

typedef struct score {
    double psnr_db, relative_rmse;
} score;

static char scratch[] = "/tmp/bench_rti.XXXXXX";

static void stop_on(weft_code code, const weft_error *error)
{
    bench_stop_on("bench_rti", code, error);
}

static void stop(const char *what, const char *name)
{
    fprintf(stderr, "bench_rti: %s '%s'\n", what, name);
    exit(WEFT_SYSTEM);
}

static void *memory(size_t count, size_t size)
{
    void *result = calloc(count + 1, size);
    if (!result)
        stop("no memory for", "pixels");
    return result;
}

static void join(char path[PATH_SIZE], const char *folder, const char *name)
{
    if (snprintf(path, PATH_SIZE, "%s/%s", folder, name) >= PATH_SIZE)
        stop("path too long:", name);
}

/* ---- Sets ---- */

static void add_lamp(lamps *some, const char *folder, const weft_listed_light *row)
{
    char path[PATH_SIZE];
    join(path, folder, row->file);
    if (some->count == MOST_LAMPS)
        stop("too many lamps:", folder);
    some->file[some->count] = strdup(path);
    some->light[some->count++] = weft_unit(row->light);
}

/* Of the lamps above the horizon every fifth, from the third, goes to `held`; NULL: none does. */
static void read_list(const char *folder, lamps *fitted, lamps *held)
{
    char path[PATH_SIZE];
    weft_light_list list;
    weft_error error = {0};
    join(path, folder, "dirs.lp");
    stop_on(weft_light_list_read(path, &list, &error), &error);
    for (int i = 0, lamp = 0; i < list.count; i++) {
        if (list.row[i].light.z > 0)
            add_lamp(held && lamp++ % EVERY == EVERY / 2 ? held : fitted, folder, &list.row[i]);
    }
    weft_light_list_free(&list);
}

/* The middles of SIDE x SIDE cells. */
static void choose_pixels(set *s, const weft_image *image)
{
    s->width = image->width;
    s->height = image->height;
    s->pixel_count = SIDE * SIDE;
    s->uv = memory(2 * (size_t)s->pixel_count, sizeof *s->uv);
    for (int i = 0; i < s->pixel_count; i++) {
        s->uv[2 * i] = (floor((i % SIDE + 0.5) / SIDE * s->width) + 0.5) / s->width;
        s->uv[2 * i + 1] = 1 - (floor((i / SIDE + 0.5) / SIDE * s->height) + 0.5) / s->height;
    }
}

static void read_values(set *s, lamps *some)
{
    for (int lamp = 0; lamp < some->count; lamp++) {
        weft_image image;
        weft_error error = {0};
        stop_on(weft_image_read(some->file[lamp], &image, NULL, &error), &error);
        if (!s->uv)
            choose_pixels(s, &image);
        if (image.width != s->width || image.height != s->height)
            stop("another size than the others:", some->file[lamp]);
        if (!some->value)
            some->value = memory((size_t)some->count * (size_t)s->pixel_count, 3 * sizeof *some->value);
        float *value = some->value + (size_t)lamp * (size_t)s->pixel_count * 3;
        for (int i = 0; i < s->pixel_count; i++) {
            int x = (int)(s->uv[2 * i] * s->width), y = (int)((1 - s->uv[2 * i + 1]) * s->height);
            memcpy(value + 3 * i, image.pixels + 3 * ((size_t)y * (size_t)s->width + (size_t)x), 3 * sizeof *value);
        }
        weft_image_free(&image);
    }
}

static void free_set(set *s)
{
    lamps *const part[] = {&s->fitted, &s->held};
    for (int p = 0; p < 2; p++) {
        for (int i = 0; i < part[p]->count; i++)
            free(part[p]->file[i]);
        free(part[p]->value);
    }
    free(s->uv);
}

/* ---- The program ---- */

static void run(char *const *argument)
{
    extern char **environ;
    pid_t child;
    int status;
    if (posix_spawn(&child, WEFT_PROGRAM, NULL, NULL, argument, environ) != 0 || waitpid(child, &status, 0) < 0 ||
        status != 0)
        stop("failed: weft", argument[1]);
}

static void write_list(const set *s)
{
    FILE *file = fopen(s->list, "w");
    if (!file)
        stop("cannot write", s->list);
    fprintf(file, "%d\n", s->fitted.count);
    for (int i = 0; i < s->fitted.count; i++) {
        weft_vec3 l = s->fitted.light[i];
        fprintf(file, "%s %.9g %.9g %.9g\n", strrchr(s->fitted.file[i], '/') + 1, (double)l.x, (double)l.y,
                (double)l.z);
    }
    fclose(file);
}

/* Dataset and material of the fitted lamps; returns the seconds of weft compress. */
static double make_material(set *s, const char *photographs, char *const *options)
{
    join(s->list, scratch, "fitted.lp");
    join(s->dataset, scratch, "fitted.btf.h5");
    join(s->material, scratch, "fitted.weft");
    write_list(s);
    run((char *[]){"weft", "import", (char *)photographs, "--lights", s->list, "-o", s->dataset, "-q", NULL});
    char *argument[MOST_WORDS] = {"weft", "compress", s->dataset, "-o", s->material, "-q"};
    for (int i = 6; *options && i < MOST_WORDS - 1; i++)
        argument[i] = *options++;
    double began = bench_now_ms(CLOCK_MONOTONIC);
    run(argument);
    return 1e-3 * (bench_now_ms(CLOCK_MONOTONIC) - began);
}

/* Also where the program ends early. */
static void remove_scratch(void)
{
    char pattern[2][PATH_SIZE];
    glob_t files = {0};
    join(pattern[0], scratch, "*/*");
    join(pattern[1], scratch, "*");
    glob(pattern[0], GLOB_NOSORT, NULL, &files);
    glob(pattern[1], GLOB_NOSORT | GLOB_APPEND, NULL, &files);
    for (size_t i = 0; i < files.gl_pathc; i++)
        remove(files.gl_pathv[i]);
    globfree(&files);
    rmdir(scratch);
}

/* ---- Predictions: [held.count][pixel_count][3], sRGB ---- */

static void predict_rti(const set *s, weft_rti_model model, float *predicted)
{
    size_t values = 3 * (size_t)s->pixel_count;
    weft_error error = {0};
    double *weight = memory((size_t)s->held.count * (size_t)s->fitted.count, sizeof *weight);
    stop_on(weft_rti_weights(model, s->fitted.light, s->fitted.count, s->held.light, s->held.count, weight, &error),
            &error);
    for (int h = 0; h < s->held.count; h++)
        for (size_t v = 0; v < values; v++) {
            double sum = 0;
            for (int f = 0; f < s->fitted.count; f++)
                sum += weight[h * s->fitted.count + f] * (double)s->fitted.value[(size_t)f * values + v];
            predicted[(size_t)h * values + v] = (float)sum;
        }
    free(weight);
}

/* White where clipped photographs leave nothing known. */
static void predict_model(const set *s, const char *path, float *predicted)
{
    const weft_model_options options = {0};
    weft_error error = {0};
    weft_model *model;
    size_t count = (size_t)s->pixel_count;
    double *light = memory(count, 3 * sizeof *light), *view = memory(count, 3 * sizeof *view);
    double *brdf = memory(count, 3 * sizeof *brdf);
    stop_on(weft_model_open(path, &options, &model, &error), &error);
    for (int h = 0; h < s->held.count; h++) {
        weft_vec3 l = s->held.light[h];
        for (size_t i = 0; i < count; i++) {
            memcpy(light + 3 * i, (double[]){(double)l.x, (double)l.y, (double)l.z}, 3 * sizeof *light);
            view[3 * i + 2] = 1;
        }
        stop_on(weft_evaluate(model, count, s->uv, NULL, light, view, brdf, &error), &error);
        for (size_t i = 0; i < 3 * count; i++) {
            double linear = brdf[i] * M_PI * (double)l.z;
            predicted[3 * count * (size_t)h + i] = isnan(linear) ? 1 : weft_srgb_of_linear((float)linear);
        }
    }
    weft_model_close(model);
    free(light);
    free(view);
    free(brdf);
}

/* ---- Scores ---- */

static score score_of(const set *s, const float *predicted)
{
    size_t values = 3 * (size_t)s->pixel_count;
    double db = 0, error = 0, square = 0;
    for (int h = 0; h < s->held.count; h++) {
        double coded = 0;
        for (size_t v = 0; v < values; v++) {
            float truth = s->held.value[(size_t)h * values + v];
            float said = fminf(fmaxf(predicted[(size_t)h * values + v], 0), 1);
            double step = (double)(roundf(255 * said) - 255 * truth);
            double sample = (double)weft_linear_of_srgb(truth), off = (double)weft_linear_of_srgb(said) - sample;
            coded += step * step;
            error += off * off;
            square += sample * sample;
        }
        db += 10 * log10(255 * 255 * (double)values / fmax(coded, 1));
    }
    return (score){db / s->held.count, sqrt(error / square)};
}

static void print_psnr(const char *name, const score result[METHODS])
{
    printf("%-36s", name);
    for (int m = 0; m < METHODS; m++)
        printf(" %7.2f", result[m].psnr_db);
}

static void print_rmse(const score result[METHODS])
{
    printf("%-36s", "  relative RMSE, linear");
    for (int m = 0; m < METHODS; m++)
        printf(" %7.4f", result[m].relative_rmse);
    printf("\n");
    fflush(stdout);
}

static bool is_folder(const char *path)
{
    struct stat status;
    return stat(path, &status) == 0 && S_ISDIR(status.st_mode);
}

static void measure(const char *folder, char *const *options, score result[METHODS])
{
    set s = {0};
    char dome[PATH_SIZE], test[PATH_SIZE];
    join(dome, folder, "Dome");
    join(test, folder, "Test");
    bool has_test = is_folder(dome) && is_folder(test);
    const char *fitted = has_test ? dome : folder;
    read_list(fitted, &s.fitted, has_test ? NULL : &s.held);
    if (has_test)
        read_list(test, &s.held, NULL);
    read_values(&s, &s.fitted);
    read_values(&s, &s.held);
    double seconds = make_material(&s, fitted, options);
    float *predicted = memory((size_t)s.held.count * (size_t)s.pixel_count, 3 * sizeof *predicted);
    for (int m = 0; m < METHODS; m++) {
        if (m < RAW)
            predict_rti(&s, (weft_rti_model)m, predicted);
        else
            predict_model(&s, m == RAW ? s.dataset : s.material, predicted);
        result[m] = score_of(&s, predicted);
    }
    struct stat file;
    stat(s.material, &file);
    const char *name = strlen(folder) > 36 ? folder + strlen(folder) - 36 : folder;
    print_psnr(name, result);
    printf("   %5.1f bytes a pixel, %.0f s, %d x %d, %d + %d lamps\n", (double)file.st_size / s.width / s.height,
           seconds, s.width, s.height, s.fitted.count, s.held.count);
    print_rmse(result);
    free(predicted);
    free_set(&s);
}

/* ---- A set that is made up ---- */

/* A bumpy sheet with a highlight, in the dark photographs of 40 lamps on a spiral. */
static void make_photograph(const char *folder, int number, weft_vec3 light)
{
    enum { SIZE = 128 };
    char name[32], path[PATH_SIZE];
    weft_image image;
    weft_error error = {0};
    stop_on(weft_image_create(SIZE, SIZE, &image, &error), &error);
    for (int i = 0; i < SIZE * SIZE; i++) {
        double x = 0.2 * (i % SIZE), y = 0.2 * (i / SIZE);
        weft_vec3 normal = weft_unit((weft_vec3){0.4 * cos(x), 0.4 * sin(y), 1});
        weft_vec3 half = weft_unit(weft_add(light, (weft_vec3){0, 0, 1}));
        double diffuse = fmax((double)weft_dot(normal, light), 0), gloss = pow((double)weft_dot(normal, half), 40);
        for (int c = 0; c < 3; c++)
            image.pixels[3 * i + c] =
                weft_srgb_of_linear((float)fmin(diffuse * (0.2 + 0.1 * c * (1 + sin(x + y))) + 0.4 * gloss, 0.95));
    }
    snprintf(name, sizeof name, "image%02d.png", number);
    join(path, folder, name);
    stop_on(weft_image_write(path, &image, NULL, &error), &error);
    weft_image_free(&image);
}

static void make_set(const char *folder)
{
    enum { COUNT = 40 };
    char path[PATH_SIZE];
    join(path, folder, "dirs.lp");
    FILE *list = mkdir(folder, 0700) == 0 ? fopen(path, "w") : NULL;
    if (!list)
        stop("cannot write", path);
    fprintf(list, "%d\n", COUNT);
    for (int i = 0; i < COUNT; i++) {
        double z = 1 - 0.8 * (i + 0.5) / COUNT, phi = 2.399963 * i, r = sqrt(1 - z * z);
        weft_vec3 light = {r * cos(phi), r * sin(phi), z};
        fprintf(list, "image%02d.png %.9g %.9g %.9g\n", i, (double)light.x, (double)light.y, z);
        make_photograph(folder, i, light);
    }
    fclose(list);
}

static void measure_made_up(char *const *options, score result[METHODS])
{
    char folder[PATH_SIZE];
    printf("no photographs are given: a synthetic set\n");
    join(folder, scratch, "synthetic");
    make_set(folder);
    measure(folder, options, result);
}

/* ---- All of them ---- */

static void measure_all(char *const *folder, size_t count, char *const *options)
{
    score result[METHODS], mean[METHODS] = {{0}};
    for (size_t i = 0; i < count; i++) {
        measure(folder[i], options, result);
        for (int m = 0; m < METHODS; m++) {
            mean[m].psnr_db += result[m].psnr_db / (double)count;
            mean[m].relative_rmse += result[m].relative_rmse / (double)count;
        }
    }
    if (count > 1) {
        print_psnr("mean", mean);
        printf("\n");
        print_rmse(mean);
    }
}

static void measure_shared(char *const *options)
{
    glob_t found = {0};
    score result[METHODS];
    glob(WEFT_SHARED "/real/rti-real/item*", 0, NULL, &found);
    glob(WEFT_SHARED "/real/rti-synth/*/*/*", GLOB_APPEND, NULL, &found);
    if (*WEFT_SHARED && found.gl_pathc > 0)
        measure_all(found.gl_pathv, found.gl_pathc, options);
    else
        measure_made_up(options, result);
    globfree(&found);
}

int main(int argc, char **argv)
{
    int folders = 0;
    while (folders + 1 < argc && strcmp(argv[folders + 1], "--") != 0)
        folders++;
    char **options = argv + folders + 1 + (folders + 1 < argc);
    if (!mkdtemp(scratch))
        stop("cannot make", scratch);
    atexit(remove_scratch);
    printf("%-36s", "PSNR of 8-bit sRGB values, dB");
    for (int m = 0; m < METHODS; m++)
        printf(" %7s", method_name[m]);
    printf("\n");
    if (folders > 0)
        measure_all(argv + 1, (size_t)folders, options);
    else
        measure_shared(options);
    return 0;
}
