#include "registration/radiometry/bracket.h"

#include <math.h>

/* ---- Whether they agree ---- */

static double range_of(const weft_session *session)
{
    return (1 << session->bits) - 1 - session->black_level;
}

void weft_bracket_compare(const weft_session *session, weft_bracket_frame *frame, int count, size_t sample_count)
{
    const double lowest = 0.3, highest = 0.9, largest_drift = 0.1;
    const long fewest = 200;
    double range = range_of(session);
    for (int i = 0; i < count; i++) {
        const weft_bracket_frame *longer = frame[i].exposure_s > frame[0].exposure_s ? &frame[i] : &frame[0];
        double sum = 0, first_sum = 0;
        long seen = 0;
        for (size_t s = 0; s < sample_count; s++) {
            double level = (longer->samples[s] - session->black_level) / range;
            if (level < lowest || level > highest)
                continue;
            sum += frame[i].samples[s] - session->black_level;
            first_sum += frame[0].samples[s] - session->black_level;
            seen++;
        }
        double gain = sum / frame[i].exposure_s / (first_sum / frame[0].exposure_s);
        frame[i].gain = seen < fewest ? 1 : fabs(gain - 1) <= largest_drift ? gain : 0;
    }
}

/* ---- Merging ---- */

/* A frame as the loop over samples wants it. */
typedef struct exposed {
    const uint16_t *samples;
    double seconds; /* that would have shown the same under the light of the first frame */
} exposed;

typedef struct merger {
    exposed frame[1 + WEFT_SESSION_MAX_BRACKETS];
    int count;
    double black, clip, per_electron, still_variance;
} merger;

static merger merger_of(const weft_session *session, const weft_bracket_frame *frame, int count)
{
    const double highest = 0.98;
    const weft_sensor_noise *noise = &session->noise;
    merger m = {.black = session->black_level, .clip = session->black_level + highest * range_of(session)};
    m.per_electron = noise->electrons_per_value > 0 ? 1 / noise->electrons_per_value : 1;
    double read = noise->read_noise_electrons * m.per_electron;
    m.still_variance = read * read + 1 / 12.0;
    for (int i = 0; i < count; i++) {
        if (frame[i].gain > 0)
            m.frame[m.count++] = (exposed){frame[i].samples, frame[i].exposure_s * frame[i].gain};
    }
    return m;
}

/* Rate by the longest frame that does not clip; INFINITY where all do. */
static double first_rate(const merger *m, size_t sample)
{
    double longest_s = 0, rate = INFINITY;
    for (int i = 0; i < m->count; i++) {
        const exposed *e = &m->frame[i];
        if (e->seconds > longest_s && e->samples[sample] <= m->clip) {
            longest_s = e->seconds;
            rate = (e->samples[sample] - m->black) / longest_s;
        }
    }
    return rate;
}

/* The estimate whose weights take the rate from `rate`; *information receives 1 / its variance. */
static double weighted_rate(const merger *m, size_t sample, double rate, double *information)
{
    double sum = 0, weights = 0;
    for (int i = 0; i < m->count; i++) {
        const exposed *e = &m->frame[i];
        if (e->samples[sample] > m->clip)
            continue;
        double variance = fmax(rate, 0) * e->seconds * m->per_electron + m->still_variance;
        sum += e->seconds / variance * (e->samples[sample] - m->black);
        weights += e->seconds * e->seconds / variance;
    }
    *information = weights;
    return sum / weights;
}

void weft_bracket_merge(const weft_session *session, const weft_bracket_frame *frame, int count, size_t sample_count,
                        float *value, float *variance)
{
    const merger m = merger_of(session, frame, count);
    double scale = frame[0].exposure_s;
    for (size_t s = 0; s < sample_count; s++) {
        double rate = first_rate(&m, s), information = INFINITY;
        for (int pass = 0; pass < 2 && isfinite(rate); pass++)
            rate = weighted_rate(&m, s, rate, &information);
        value[s] = (float)(rate * scale);
        variance[s] = (float)(scale * scale / information);
    }
}
