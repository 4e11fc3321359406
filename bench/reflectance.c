/* Evaluations per second on one core of the functions that the stages call most. Usage: bench_reflectance [WEAVE.wv
 * ...] */
#include "base/clock.h"
#include "base/processor.h"
#include "btf/direction/direction.h"
#include "reflectance/lafortune/lafortune.h"
#include "reflectance/weave/batch.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

enum { SAMPLES = 1 << 14, ROUNDS = 64 };

typedef struct sample {
    weft_weave_point point;
    weft_real U, V;
    weft_vec3 light, view;
} sample;

/* Of this thread, so that a busy machine does not count. */
static double now_s(void)
{
    return weft_clock_seconds(CLOCK_THREAD_CPUTIME_ID);
}

/* Linear congruential, upper bits (Knuth's MMIX constants): enough to spread samples. */
static weft_real random_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (weft_real)(*state >> 11) / (weft_real)9007199254740992.0;
}

/* The places of cameras and lights of a capture: theta up to 75 degrees. */
static weft_vec3 random_direction(uint64_t *state)
{
    weft_angles angles = {weft_rad_of_deg(75) * sqrt(random_unit(state)), 2 * (weft_real)WEFT_PI * random_unit(state)};
    return weft_direction_of_angles(angles);
}

static sample *make_samples(const weft_weave *weave, uint64_t noise_seed)
{
    uint64_t state = 1;
    sample *samples = malloc(SAMPLES * sizeof *samples);
    for (int i = 0; samples && i < SAMPLES; i++) {
        sample *s = &samples[i];
        *s = (sample){.U = 16 * random_unit(&state), .V = 16 * random_unit(&state)};
        s->light = random_direction(&state);
        s->view = random_direction(&state);
        s->point = weft_weave_locate(weave, s->U, s->V, noise_seed);
    }
    return samples;
}

/* Keeps results alive. */
static volatile weft_real sink;

static double specular_rate(const weft_weave *weave, const sample *samples, double *lit)
{
    weft_real sum = 0;
    long positive = 0;
    double start = now_s();
    for (int round = 0; round < ROUNDS; round++) {
        for (int i = 0; i < SAMPLES; i++) {
            weft_real value = weft_weave_specular(weave, &samples[i].point, samples[i].light, samples[i].view);
            positive += value > 0;
            sum += value;
        }
    }
    double seconds = now_s() - start;
    sink = sum;
    *lit = (double)positive / ((double)ROUNDS * SAMPLES);
    return (double)ROUNDS * SAMPLES / seconds;
}

/* The same in batches, with and without filling them. */
static double batch_rate(const weft_weave *weave, const sample *samples, bool filled_once)
{
    weft_woven_table *table;
    weft_error error = {0};
    if (weft_woven_table_create(weave, &table, &error) != WEFT_OK)
        return 0;
    weft_weave_batch batch = {.count = 0};
    float sum = 0;
    double start = now_s();
    for (int i = 0; i < ROUNDS * SAMPLES / WEFT_BATCH_SIZE; i++) {
        int first = i * WEFT_BATCH_SIZE % SAMPLES;
        if (!filled_once || i == 0) {
            batch.count = 0;
            for (int k = 0; k < WEFT_BATCH_SIZE; k++)
                weft_weave_batch_put(&batch, &samples[first + k].point, samples[first + k].light,
                                     samples[first + k].view);
        }
        weft_weave_specular_batch(table, &batch);
        sum += batch.specular[i % WEFT_BATCH_SIZE];
    }
    double seconds = now_s() - start;
    sink = (weft_real)sum;
    weft_woven_table_free(table);
    return (double)ROUNDS * SAMPLES / seconds;
}

static double locate_rate(const weft_weave *weave, const sample *samples, uint64_t noise_seed)
{
    weft_real sum = 0;
    double start = now_s();
    for (int round = 0; round < ROUNDS; round++)
        for (int i = 0; i < SAMPLES; i++)
            sum += weft_weave_locate(weave, samples[i].U, samples[i].V, noise_seed).x;
    sink = sum;
    return (double)ROUNDS * SAMPLES / (now_s() - start);
}

/* Reflectances of one segment, and means over the tile, per second. */
typedef struct reflectance_rates {
    double exact, fast, tile_exact, tile_fast;
} reflectance_rates;

static double rate_since(double start, int count)
{
    return count / (now_s() - start);
}

static reflectance_rates measure_reflectances(const weft_weave *weave, const sample *samples)
{
    enum { FEW = 128, MANY = 4096 };
    static weft_vec3 light[MANY], view[MANY];
    static weft_real value[MANY];
    const weft_prepared_segment *prepared = &weave->yarn[0].prepared;
    reflectance_rates rates = {0};
    weft_error error = {0};
    weft_real sum = 0;
    for (int i = 0; i < MANY; i++) {
        light[i] = samples[i].light;
        view[i] = samples[i].view;
    }
    double start = now_s();
    for (int i = 0; i < FEW; i++)
        sum += weft_prepared_reflectance(prepared, light[i], view[i]);
    rates.exact = rate_since(start, FEW);
    start = now_s();
    weft_prepared_reflectance_batch(prepared, MANY, light, view, value);
    rates.fast = rate_since(start, MANY);
    start = now_s();
    for (int i = 0; i < FEW; i++)
        sum += weft_weave_mean_specular(weave, light[i], view[i]);
    rates.tile_exact = rate_since(start, FEW);
    start = now_s();
    if (weft_weave_mean_specular_batch(weave, MANY, light, view, value, &error) == WEFT_OK)
        rates.tile_fast = rate_since(start, MANY);
    sink = sum + value[0];
    return rates;
}

static int bench_weave(const char *path)
{
    weft_weave weave;
    weft_error error = {0};
    double start = now_s(), lit, lit_noisy;
    if (weft_weave_read(path, NULL, 0, &weave, NULL, &error) != WEFT_OK) {
        fprintf(stderr, "%s\n", error.message);
        return 1;
    }
    double load_s = now_s() - start;
    sample *plain = make_samples(&weave, 0), *noisy = make_samples(&weave, 1);
    if (!plain || !noisy)
        return 1;
    double plain_rate = specular_rate(&weave, plain, &lit), noisy_rate = specular_rate(&weave, noisy, &lit_noisy);
    printf(
        "%-24s load %5.3f s (this thread)   texture %6.2f M/s (%2.0f %% lit)   with noise %6.2f M/s (%2.0f %% lit)   "
        "locate %6.1f M/s   with noise %6.1f M/s\n",
        weave.name, load_s, plain_rate / 1e6, 100 * lit, noisy_rate / 1e6, 100 * lit_noisy,
        locate_rate(&weave, plain, 0) / 1e6, locate_rate(&weave, plain, 1) / 1e6);
    reflectance_rates r = measure_reflectances(&weave, plain);
    printf("  in batches (%s): texture %6.2f M/s   filled %6.2f M/s   with noise, filled %6.2f M/s\n"
           "  reflectance %6.0f /s, in batches %7.3f M/s   tile mean %6.0f /s, in batches %7.3f M/s\n",
           weft_instruction_set_name(weft_processor_instruction_set()), batch_rate(&weave, plain, true) / 1e6,
           batch_rate(&weave, plain, false) / 1e6, batch_rate(&weave, noisy, false) / 1e6, r.exact, r.fast / 1e6,
           r.tile_exact, r.tile_fast / 1e6);
    free(plain);
    free(noisy);
    weft_weave_free(&weave);
    return 0;
}

static void bench_lobes(void)
{
    uint64_t state = 1;
    const weft_lobe lobes[2] = {{-1, -1, 1, 20}, {-0.6, -0.7, 0.9, 3.5}};
    static weft_vec3 light[SAMPLES], view[SAMPLES];
    for (int i = 0; i < SAMPLES; i++) {
        light[i] = random_direction(&state);
        view[i] = random_direction(&state);
    }
    weft_real sum = 0;
    double start = now_s();
    for (int round = 0; round < ROUNDS; round++)
        for (int i = 0; i < SAMPLES; i++)
            sum += weft_lafortune((weft_real)0.1, lobes, 2, light[i], view[i]);
    double seconds = now_s() - start;
    sink = sum;
    printf("Lafortune, 2 lobes, 1 channel: %.2f M/s\n", (double)ROUNDS * SAMPLES / seconds / 1e6);
}

int main(int argc, char **argv)
{
    static const char *const assets[] = {"cotton_denim",   "cotton_twill",  "polyester_lining",
                                         "silk_charmeuse", "silk_shantung", "wool_gabardine"};
    int failures = 0;
    bench_lobes();
    for (int i = 1; i < argc; i++)
        failures += bench_weave(argv[i]);
    for (size_t i = 0; argc == 1 && i < sizeof assets / sizeof *assets; i++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/weaves/%s.wv", WEFT_ASSETS, assets[i]);
        failures += bench_weave(path);
    }
    return failures > 0;
}
