#include "btf/material/certificate.h"

#include "base/integers.h"
#include "base/text/json_text.h"

#include <math.h>
#include <string.h>

/* Factors and shares are stored as whole thousandths: short, and the same in every locale and version. */
static const double thousandths = 1000;

/* ---- Evaluation ---- */

static double spread_of(const weft_certificate *c, double value)
{
    double relative = value / c->mean;
    int k = 1;
    if (!(relative > c->value[0]))
        return c->spread[0];
    while (k < WEFT_CERTIFICATE_KNOTS && c->value[k] < relative)
        k++;
    if (k == WEFT_CERTIFICATE_KNOTS)
        return c->spread[k - 1];
    double at = (relative - c->value[k - 1]) / (c->value[k] - c->value[k - 1]);
    return c->spread[k - 1] + at * (c->spread[k] - c->spread[k - 1]);
}

static int ring_of(weft_vec3 direction)
{
    return weft_ubo81_ring(weft_angles_of_direction(direction).theta_rad);
}

double weft_certificate_scale_of_rings(const weft_certificate *c, double value, int light_ring, int view_ring)
{
    return c->mean * spread_of(c, value) * c->view[view_ring] * c->light[light_ring];
}

static int level_index(const weft_certificate *c, double level)
{
    return weft_smaller(level > 0 ? (int)fmin(level, WEFT_MATERIAL_MAX_LEVELS) : 0, c->level_count - 1);
}

double weft_certificate_half_width(const weft_certificate *c, double level, double value, weft_vec3 light,
                                   weft_vec3 view)
{
    if (!(light.z > 0 && view.z > 0))
        return 0;
    return c->level[level_index(c, level)].quantile *
           weft_certificate_scale_of_rings(c, value, ring_of(light), ring_of(view));
}

bool weft_certificate_is_measured(const weft_certificate *c, double level)
{
    return (level > 0 ? floor(level) : 0) < c->measured_levels;
}

weft_certificate_parts weft_certificate_parts_of(const weft_certificate *c, int level, int ring)
{
    const weft_certificate_level *at = &c->level[level_index(c, level)];
    double fitted = at->fitted[ring], storage = at->storage[ring], registration = at->registration[ring];
    return (weft_certificate_parts){
        .sampling = fmax(0, 1 - fitted),
        .registration = registration,
        .model = sqrt(fmax(0, fitted * fitted - storage * storage - registration * registration)),
        .storage = storage,
    };
}

/* ---- To JSON ---- */

/* Every list of numbers that is stored in thousandths. */
static void round_list(double *number, int count, double least)
{
    for (int i = 0; i < count; i++)
        number[i] = fmax(least, round(thousandths * number[i])) / thousandths;
}

void weft_certificate_round(weft_certificate *c)
{
    round_list(c->value, WEFT_CERTIFICATE_KNOTS, 0);
    for (int k = 1; k < WEFT_CERTIFICATE_KNOTS; k++) {
        if (!(c->value[k] >= c->value[k - 1] + 0.5 / thousandths))
            c->value[k] = c->value[k - 1] + 1 / thousandths;
    }
    round_list(c->spread, WEFT_CERTIFICATE_KNOTS, 1);
    round_list(c->view, WEFT_RING_COUNT, 1);
    round_list(c->light, WEFT_RING_COUNT, 1);
    for (int k = 0; k < c->level_count; k++) {
        weft_certificate_level *level = &c->level[k];
        level->quantile = fmax(1, ceil(thousandths * level->quantile - 1e-6)) / thousandths;
        round_list(level->fitted, WEFT_RING_COUNT, 0);
        round_list(level->storage, WEFT_RING_COUNT, 0);
        round_list(level->registration, WEFT_RING_COUNT, 0);
    }
}

static json_t *pack_list(const double *number, int count)
{
    json_t *list = json_array();
    for (int i = 0; i < count; i++)
        weft_json_append(&list, json_integer((json_int_t)llround(thousandths * number[i])));
    return list;
}

static json_t *pack_counts(const int *number)
{
    json_t *list = json_array();
    for (int i = 0; i < WEFT_RING_COUNT; i++)
        weft_json_append(&list, json_integer(number[i]));
    return list;
}

/* Of every level the list that lies `offset` bytes into weft_certificate_level. */
static json_t *pack_shares(const weft_certificate *c, size_t offset)
{
    json_t *list = json_array();
    for (int k = 0; k < c->level_count; k++)
        weft_json_append(
            &list, pack_list((const double *)(const void *)((const char *)&c->level[k] + offset), WEFT_RING_COUNT));
    return list;
}

static json_t *pack_quantiles(const weft_certificate *c)
{
    json_t *list = json_array();
    for (int k = 0; k < c->level_count; k++)
        weft_json_append(&list, json_integer((json_int_t)llround(thousandths * c->level[k].quantile)));
    return list;
}

json_t *weft_certificate_pack(const weft_certificate *c)
{
    json_t *object = json_pack("{s:f, s:s, s:i, s:i, s:f}", "probability", c->probability, "over",
                               c->over_images ? "images" : "pixels", "images", c->image_count, "directions",
                               c->direction_count, "mean", c->mean);
    weft_json_put(&object, "values", pack_list(c->value, WEFT_CERTIFICATE_KNOTS));
    weft_json_put(&object, "spreads", pack_list(c->spread, WEFT_CERTIFICATE_KNOTS));
    weft_json_put(&object, "views", pack_list(c->view, WEFT_RING_COUNT));
    weft_json_put(&object, "lights", pack_list(c->light, WEFT_RING_COUNT));
    weft_json_put(&object, "images_by_view", pack_counts(c->view_images));
    weft_json_put(&object, "images_by_light", pack_counts(c->light_images));
    weft_json_put(&object, "quantiles", pack_quantiles(c));
    if (c->measured_levels > 0)
        weft_json_put(&object, "measured_levels", json_integer(c->measured_levels));
    weft_json_put(&object, "fitted", pack_shares(c, offsetof(weft_certificate_level, fitted)));
    weft_json_put(&object, "storage", pack_shares(c, offsetof(weft_certificate_level, storage)));
    if (c->has_registration)
        weft_json_put(&object, "registration", pack_shares(c, offsetof(weft_certificate_level, registration)));
    return object;
}

/* ---- From JSON ---- */

enum { LARGEST = 1000000000 };

/* `count` whole numbers from `least` to a thousand million, times `unit`. */
static bool read_list(const json_t *list, size_t count, int least, double unit, double *number)
{
    if (!json_is_array(list) || json_array_size(list) != count)
        return false;
    for (size_t i = 0; i < count; i++) {
        const json_t *item = json_array_get(list, i);
        json_int_t value = json_integer_value(item);
        if (!json_is_integer(item) || value < least || value > LARGEST)
            return false;
        number[i] = (double)value * unit;
    }
    return true;
}

static bool read_factors(const json_t *object, const char *name, size_t count, double *number)
{
    return read_list(json_object_get(object, name), count, 1, 1 / thousandths, number);
}

static bool read_counts(const json_t *object, const char *name, int *count)
{
    double number[WEFT_RING_COUNT];
    if (!read_list(json_object_get(object, name), WEFT_RING_COUNT, 0, 1, number))
        return false;
    for (int i = 0; i < WEFT_RING_COUNT; i++)
        count[i] = (int)number[i];
    return true;
}

static bool read_values(const json_t *object, double *value)
{
    bool ascends = read_list(json_object_get(object, "values"), WEFT_CERTIFICATE_KNOTS, 0, 1 / thousandths, value);
    for (int k = 1; k < WEFT_CERTIFICATE_KNOTS && ascends; k++)
        ascends = value[k] > value[k - 1];
    return ascends;
}

static bool read_shares(const json_t *list, weft_certificate *c, size_t offset)
{
    if (!json_is_array(list) || json_array_size(list) != (size_t)c->level_count)
        return false;
    bool complete = true;
    for (int k = 0; k < c->level_count && complete; k++)
        complete = read_list(json_array_get(list, (size_t)k), WEFT_RING_COUNT, 0, 1 / thousandths,
                             (double *)(void *)((char *)&c->level[k] + offset));
    return complete;
}

static bool read_whole(const json_t *object, const char *name, int *number)
{
    const json_t *item = json_object_get(object, name);
    json_int_t value = json_integer_value(item);
    *number = (int)value;
    return json_is_integer(item) && value >= 1 && value <= LARGEST;
}

static bool read_levels(const json_t *object, weft_certificate *c)
{
    double quantile[WEFT_MATERIAL_MAX_LEVELS];
    size_t count = json_array_size(json_object_get(object, "quantiles"));
    if (count < 1 || count > WEFT_MATERIAL_MAX_LEVELS || !read_factors(object, "quantiles", count, quantile))
        return false;
    c->level_count = (int)count;
    for (size_t k = 0; k < count; k++)
        c->level[k].quantile = quantile[k];
    const json_t *measured = json_object_get(object, "measured_levels");
    if (measured &&
        !(read_whole(object, "measured_levels", &c->measured_levels) && c->measured_levels <= c->level_count))
        return false;
    const json_t *registration = json_object_get(object, "registration");
    c->has_registration = registration != NULL;
    return read_shares(json_object_get(object, "fitted"), c, offsetof(weft_certificate_level, fitted)) &&
           read_shares(json_object_get(object, "storage"), c, offsetof(weft_certificate_level, storage)) &&
           (!registration || read_shares(registration, c, offsetof(weft_certificate_level, registration)));
}

static bool read_over(const json_t *object, bool *over_images)
{
    const char *over = json_string_value(json_object_get(object, "over"));
    *over_images = over && strcmp(over, "images") == 0;
    return *over_images || (over && strcmp(over, "pixels") == 0);
}

const char *weft_certificate_unpack(const json_t *object, weft_certificate *c)
{
    *c = (weft_certificate){.probability = json_number_value(json_object_get(object, "probability")),
                            .mean = json_number_value(json_object_get(object, "mean"))};
    if (!(c->probability > 0 && c->probability < 1))
        return "holds a certificate whose probability is not between 0 and 1";
    if (!(c->mean > 0 && c->mean < INFINITY))
        return "holds a certificate whose mean is not above 0";
    if (!read_over(object, &c->over_images) || !read_whole(object, "images", &c->image_count) ||
        !read_whole(object, "directions", &c->direction_count) ||
        !read_counts(object, "images_by_view", c->view_images) ||
        !read_counts(object, "images_by_light", c->light_images))
        return "holds a certificate that does not say what was held out";
    if (!read_values(object, c->value))
        return "holds a certificate whose values do not ascend";
    if (!read_factors(object, "spreads", WEFT_CERTIFICATE_KNOTS, c->spread) ||
        !read_factors(object, "views", WEFT_RING_COUNT, c->view) ||
        !read_factors(object, "lights", WEFT_RING_COUNT, c->light))
        return "holds a certificate with a factor that is no whole number above 0";
    if (!read_levels(object, c))
        return "holds a certificate whose levels are not complete";
    return NULL;
}

weft_code weft_certificate_read(const char *metadata, bool *found, weft_certificate *certificate, weft_error *error)
{
    errno = 0;
    json_t *root = json_loads(metadata, 0, NULL);
    const json_t *object = json_object_get(root, "certificate");
    *found = object != NULL;
    const char *fault = object ? weft_certificate_unpack(object, certificate) : NULL;
    bool is_short = !root && errno == ENOMEM;
    json_decref(root);
    if (is_short)
        return weft_fail_memory(error, "metadata of the material", strlen(metadata));
    return fault ? weft_fail(error, WEFT_BAD_INPUT, "the material %s", fault) : WEFT_OK;
}
