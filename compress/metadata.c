#include "compress/metadata.h"

#include "base/text/json_text.h"
#include "btf/dataset/measured.h"

#include <stdlib.h>
#include <string.h>

const char *weft_compress_model_name(weft_compress_model model)
{
    static const char *const name[] = {"components", "lobes and view table", "lobes", "sparse"};
    return name[model];
}

/* As in compress/kriging/covariance.h: base 2 logarithms of variances and lengths. */
static json_t *list_exponents(const weft_covariance *covariance)
{
    static const char *const name[WEFT_INCIDENCE_POWER] = {[WEFT_NOISE] = "noise",
                                                           [WEFT_DIFFUSE_VARIANCE] = "diffuse_variance",
                                                           [WEFT_SMOOTH_LIGHT_LENGTH] = "light_length",
                                                           [WEFT_SMOOTH_VIEW_LENGTH] = "view_length",
                                                           [WEFT_HIGHLIGHT_VARIANCE] = "highlight_variance",
                                                           [WEFT_HIGHLIGHT_LENGTH] = "highlight_length",
                                                           [WEFT_HIGHLIGHT_VIEW_LENGTH] = "highlight_view_length",
                                                           [WEFT_FIXED_HIGHLIGHT_VARIANCE] = "fixed_variance",
                                                           [WEFT_FIXED_HIGHLIGHT_LENGTH] = "fixed_length"};
    json_t *numbers = json_object();
    for (int k = 0; k < WEFT_INCIDENCE_POWER; k++)
        weft_json_put(&numbers, name[k], json_real(covariance->number[k]));
    return numbers;
}

static json_t *describe_mean(const weft_components_report *report)
{
    weft_covariance_terms terms = weft_covariance_terms_of(&report->mean);
    return json_pack("{s:[f, f], s:o, s:f, s:f}", "left_out_relative_rmse", report->mean_error[0],
                     report->mean_error[1], "log2_covariance", list_exponents(&report->mean), "reciprocity",
                     terms.reciprocity, "half_turn", terms.half_turn);
}

/* And the powers by which highlights grow. */
static json_t *describe_kriging(const weft_components_report *report)
{
    weft_covariance_terms terms = weft_covariance_terms_of(&report->covariance);
    json_t *kriging = json_pack("{s:f, s:i, s:o, s:{s:f, s:f, s:f}}", "left_out_relative_rmse", report->left_out_error,
                                "left_out_images", report->left_out_count, "log2_covariance",
                                list_exponents(&report->covariance), "highlight_powers", "incidence",
                                terms.incidence_power, "light", terms.light_power, "view", terms.view_power);
    if (report->mean.is_of_mean)
        weft_json_put(&kriging, "mean", describe_mean(report));
    return kriging;
}

static void append_errors(json_t **list, const weft_component_errors *errors)
{
    weft_json_append(list, json_pack("[f, f]", errors->linear, errors->screen));
}

/* Errors of linear light and on a screen of three forms and of all exponents; those that were not tried are 0.
 * Scattered images try two maps. */
static json_t *list_trials(const weft_components_report *report)
{
    json_t *trials = json_array();
    for (int map = 0; map < 2 && report->scattered; map++)
        weft_json_append(&trials, json_real(report->scattered_error[map]));
    for (int form = 0; form < WEFT_COMPONENT_FORMS && !report->scattered; form++)
        append_errors(&trials, &report->trial.of_form[form]);
    for (int exponent = 0; exponent < WEFT_COMPONENT_EXPONENTS && !report->scattered; exponent++)
        append_errors(&trials, &report->trial.of_exponent[exponent]);
    return trials;
}

/* Relative RMSE of the outermost views, lights, and of both; 0: there are none. */
static json_t *describe_outermost(const weft_component_trial *trial)
{
    const weft_component_errors *of = trial->of_outermost;
    return json_pack("{s:f, s:f, s:f, s:f}", "from_deg", trial->outermost_deg, "view", of[0].linear, "light",
                     of[1].linear, "both", of[2].linear);
}

static json_t *describe_components(const weft_compress_options *options, const weft_components_report *report)
{
    const weft_component_plan *plan = &report->plan;
    const weft_error_summary *fitted = &report->fitted;
    json_t *components = json_pack(
        "{s:i, s:s, s:f, s:[f, f], s:o, s:i, s:{s:f, s:f, s:f, s:f, s:o}}", "count", options->component_count,
        "maps_over", weft_components_are_over_half_vector(plan->kind) ? "half vector" : "light", "exponent",
        (double)plan->exponent, "powers", (double)plan->incidence_power, (double)plan->cosine_power,
        "trial_relative_rmse", list_trials(report), "learned_from_texels", report->training_texels, "fitted",
        "median_relative", fitted->median_relative, "percentile80_relative", fitted->percentile80_relative, "rmse",
        fitted->rmse, "relative_rmse", fitted->relative_rmse, "psnr_db", weft_json_number(fitted->psnr_db));
    if (report->trial.outermost_deg > 0)
        weft_json_put(&components, "outermost", describe_outermost(&report->trial));
    if (report->scattered)
        weft_json_put(&components, "kriging", describe_kriging(report));
    return components;
}

static void describe_lobes(const weft_compress_report *report, const weft_sparse_setting *setting, json_t **fit)
{
    weft_json_put(fit, "lobes", json_integer(report->lobe_count));
    if (report->model != WEFT_COMPRESS_SPARSE)
        return;
    weft_json_put(fit, "largest_exponent", json_real(setting->largest_exponent));
    weft_json_put(fit, "fitted_normals", json_boolean(setting->stiffness < 1e300));
}

static json_t *describe_fit(const weft_compress_options *options, const weft_compress_report *report,
                            const weft_sparse_setting *setting)
{
    json_t *fit =
        json_pack("{s:s, s:I, s:I, s:I, s:I}", "model", weft_compress_model_name(report->model), "samples",
                  (json_int_t)report->sample_count, "masked_samples", (json_int_t)report->masked_count, "texels",
                  (json_int_t)report->texel_count, "empty_texels", (json_int_t)report->empty_texel_count);
    if (options->weights == WEFT_WEIGHTS_SCREEN && report->model != WEFT_COMPRESS_SPARSE)
        weft_json_put(&fit, "weights", json_string("screen"));
    if (report->model == WEFT_COMPRESS_COMPONENTS)
        weft_json_put(&fit, "components", describe_components(options, &report->components));
    else
        describe_lobes(report, setting, &fit);
    return fit;
}

weft_code weft_compress_describe(const weft_dataset_layout *layout, const weft_compress_options *options,
                                 const weft_compress_report *report, const weft_dataset_fingerprint *fingerprint,
                                 const weft_sparse_setting *setting, weft_material *material, weft_error *error)
{
    char layout_text[WEFT_CHECKSUM_TEXT], samples_text[WEFT_CHECKSUM_TEXT];
    weft_checksum_print(fingerprint->layout, layout_text);
    weft_checksum_print(fingerprint->samples, samples_text);
    json_t *provenance = json_loads(layout->provenance, 0, NULL);
    weft_measured measured = weft_measured_of(layout);
    json_t *object = json_pack("{s:o, s:o, s:{s:s, s:s}, s:o}", "measured", weft_measured_pack(&measured), "provenance",
                               provenance, "dataset", "layout", layout_text, "samples", samples_text, "fit",
                               describe_fit(options, report, setting));
    char *text = object ? json_dumps(object, JSON_COMPACT | JSON_SORT_KEYS) : NULL;
    json_decref(object);
    if (!text)
        return weft_fail_memory(error, "metadata of the material", 0);
    free(material->metadata);
    material->metadata = text;
    return WEFT_OK;
}
