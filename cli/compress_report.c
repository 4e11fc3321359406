#include "cli/compress_report.h"

#include "base/atomic_file.h"
#include "btf/material/held_out.h"
#include "btf/material/metadata.h"
#include "cli/command/describe.h"
#include "compare/tradeoff/frame_timer.h"
#include "edit/blend/blend.h"

#include <math.h>
#include <stdio.h>

/* Of the pairs of texels across the border of a material so many differ visibly, where one in a hundred would; or they
 * differ so much more than neighbours do in the mean. */
static const double visible_share = 0.1, visible_difference = 1.5;

/* Of more no seam is looked for: it would take more memory than the fit. */
static const long most_texels_of_seam = 1L << 20;

static const char *counted_lobes(int count)
{
    static const char *const words[] = {"no lobe", "1 lobe", "2 lobes", "3 lobes"};
    return words[count];
}

/* Which model was fitted, and where it is less than was asked for. */
static void report_model(const weft_compressed *done)
{
    const weft_common_options *common = done->common;
    const weft_compress_report *report = done->report;
    const weft_dataset_layout *layout = weft_dataset_get_layout(done->dataset);
    char model[64];
    if (report->model == WEFT_COMPRESS_COMPONENTS)
        snprintf(model, sizeof model, "%d components", done->options->component_count);
    else
        snprintf(model, sizeof model, "%s%s", counted_lobes(report->lobe_count),
                 report->model == WEFT_COMPRESS_TABLE ? " with a view table" : "");
    weft_command_say(common, "%d x %d texels, %d images, %s", layout->width, layout->height, layout->image_count,
                     model);
    if (report->model == WEFT_COMPRESS_SPARSE)
        weft_command_say(common,
                         "%d images are too few to fit lobes in every texel: neighbours share exponents and normals, "
                         "amplitudes are the texel's own",
                         layout->image_count);
    else if (report->model == WEFT_COMPRESS_LOBES)
        weft_command_say(common, "%s: no view table",
                         layout->distance == WEFT_NEAR ? "near cameras" : "too few images for its directions");
    if (report->model == WEFT_COMPRESS_SPARSE && done->options->weights != WEFT_WEIGHTS_EVEN)
        weft_command_say(common, "with so few images --weights changes nothing");
}

static void report_counts(const weft_compressed *done)
{
    const weft_compress_report *report = done->report;
    weft_command_say(done->common, "masked: %.2f %% of the samples; %ld of %ld texels without any",
                     100.0 * (double)report->masked_count / (double)report->sample_count, report->empty_texel_count,
                     report->texel_count);
}

static void report_certificate(const weft_common_options *common, const weft_certificate *certificate)
{
    char line[WEFT_HOLD_OUT_LINE];
    weft_certificate_describe(certificate, line);
    weft_command_say(common, "  certificate: %s;", line);
    weft_certificate_row(certificate, 2, line);
    weft_command_say(common, "    for a predicted value of %.3g, view and light at 30 degrees: %s", certificate->mean,
                     line);
    weft_certificate_describe_levels(certificate, line);
    if (line[0])
        weft_command_say(common, "    %s", line);
}

/* An event of what is in the metadata, too. */
static weft_code report_hold_out(const weft_common_options *common, const weft_hold_out *result, weft_error *error)
{
    char line[WEFT_HOLD_OUT_LINE];
    weft_hold_out_headline(result, line);
    weft_command_say(common, "%s", line);
    weft_hold_out_explain(result, line);
    weft_command_say(common, "  %s", line);
    if (result->has_certificate)
        report_certificate(common, &result->certificate);
    return weft_command_report(common, "held_out", weft_hold_out_to_json(result), error);
}

/* Of lobes, level by level. */
static void report_errors(const weft_common_options *common, const weft_material *material)
{
    weft_command_say(common, "on the samples that were fitted:");
    weft_command_say(common, "level       texels   rel. RMSE  median rel.  80 %% rel.  PSNR dB  RMSE");
    for (int k = 0; k < material->level_count; k++) {
        const weft_material_level *level = &material->level[k];
        const weft_error_summary *error = &level->error;
        weft_command_say(common, "%5d  %5d x %-5d  %7.2f %%  %9.2f %%  %7.2f %%  %7.2f  %9.3e", k, level->width,
                         level->height, 100 * error->relative_rmse, 100 * error->median_relative,
                         100 * error->percentile80_relative, error->psnr_db, error->rmse);
        char event[320], psnr[WEFT_NUMBER_SIZE];
        snprintf(event, sizeof event,
                 "{\"event\":\"level\",\"level\":%d,\"width\":%d,\"height\":%d,\"median_relative\":%.6g,"
                 "\"percentile80_relative\":%.6g,\"rmse\":%.6g,\"relative_rmse\":%.6g,\"psnr_db\":%s}",
                 k, level->width, level->height, error->median_relative, error->percentile80_relative, error->rmse,
                 error->relative_rmse, weft_command_number(error->psnr_db, psnr));
        weft_command_event(common, event);
    }
}

static void report_plan(const weft_common_options *common, const weft_compress_options *options,
                        const weft_components_report *components)
{
    const weft_component_plan *plan = &components->plan;
    const weft_component_trial *trial = &components->trial;
    char coding[48] = "linear values", chosen[160] = "too few images to choose by";
    const weft_component_errors *linear = &trial->of_exponent[0], *own = linear;
    for (int i = 0; i < WEFT_COMPONENT_EXPONENTS; i++)
        own = weft_component_exponent(i) == plan->exponent ? &trial->of_exponent[i] : own;
    if (plan->exponent != 1)
        snprintf(coding, sizeof coding, "values coded by a power of 1 / %g", (double)plan->exponent);
    if (trial->image_count > 0)
        snprintf(chosen, sizeof chosen,
                 "chosen by held-out images: relative RMSE %.2f %%, as a screen shows it %.2f %% (linear values: %.2f "
                 "%% and %.2f %%)",
                 100 * own->linear, 100 * own->screen, 100 * linear->linear, 100 * linear->screen);
    weft_command_say(common, "%d components of %s over %s, learned from %d texels; %s", options->component_count,
                     coding, weft_components_are_over_half_vector(plan->kind) ? "the half vector" : "the light",
                     components->training_texels, chosen);
}

/* What the outermost ring says of what lies beyond it. */
static void report_outermost(const weft_common_options *common, const weft_component_trial *trial)
{
    static const char *const kind[] = {"views", "lights", "both"};
    char list[120] = "", event[240];
    size_t used = 0;
    for (int i = 0; i < 3; i++) {
        if (trial->of_outermost[i].linear > 0)
            used += (size_t)snprintf(list + used, sizeof list - used, "%s%.0f %% (%s)", used > 0 ? ", " : "",
                                     100 * trial->of_outermost[i].linear, kind[i]);
    }
    if (used == 0)
        return;
    weft_command_say(common,
                     "beyond the photographs: relative RMSE %s; measured with directions of %.0f degrees and more left "
                     "out",
                     list, trial->outermost_deg);
    snprintf(event, sizeof event,
             "{\"event\":\"outermost\",\"from_deg\":%.1f,\"view\":%.4g,\"light\":%.4g,\"both\":%.4g}",
             trial->outermost_deg, trial->of_outermost[0].linear, trial->of_outermost[1].linear,
             trial->of_outermost[2].linear);
    weft_command_event(common, event);
}

static void report_scattered(const weft_common_options *common, const weft_compress_options *options,
                             const weft_components_report *components)
{
    if (components->left_out_count < 2)
        weft_command_say(common, "one photograph says nothing about other directions; they are guessed");
    else
        weft_command_say(common,
                         "scattered photographs: completed by kriging; relative RMSE %.2f %% when each of %d is "
                         "predicted from the others",
                         100 * components->left_out_error, components->left_out_count);
    weft_command_say(common,
                     "%d components over %s, learned from %d texels; on fitted images to choose: %.2f %% over the "
                     "light, %.2f %% over the half vector (relative RMSE)",
                     options->component_count,
                     weft_components_are_over_half_vector(components->plan.kind) ? "the half vector" : "the light",
                     components->training_texels, 100 * components->scattered_error[0],
                     100 * components->scattered_error[1]);
}

static void report_components(const weft_common_options *common, const weft_compress_options *options,
                              const weft_components_report *components)
{
    if (components->scattered)
        report_scattered(common, options, components);
    else
        report_plan(common, options, components);
    report_outermost(common, &components->trial);
    weft_command_say(
        common,
        "components at those texels, fitted samples: rel. RMSE %.2f %%, median rel. %.2f %%, 80 %% rel. %.2f %%, "
        "PSNR %.2f dB",
        100 * components->fitted.relative_rmse, 100 * components->fitted.median_relative,
        100 * components->fitted.percentile80_relative, components->fitted.psnr_db);
}

/* The last code of a ceiling stands for all that is above: samples in photons or counts are clipped. */
static void report_ceiling(const weft_compressed *done)
{
    const weft_components *components = done->material->components;
    if (!components)
        return;
    const weft_components_level *finest = &components->level[0];
    size_t count = weft_ceiling_count(finest->width, finest->height), cut = 0;
    for (size_t i = 0; i < count; i++)
        cut += finest->ceiling[i] == UINT8_MAX;
    if (cut > 0)
        weft_command_say(done->common,
                         "values above %.0f were clipped in %zu of %zu squares of %d x %d texels: check that a white "
                         "diffuser is 1, or "
                         "fit lobes (--lobes 2)",
                         (double)weft_ceiling_of_code(UINT8_MAX), cut, count, WEFT_CEILING_SIDE, WEFT_CEILING_SIDE);
}

/* Whoever lays the cloth larger than the sample sees where it is repeated, unless it tiles. */
static void report_seam(const weft_compressed *done)
{
    const weft_material_level *finest = &done->material->level[0];
    weft_seam seam;
    weft_error ignored;
    char event[192];
    if (done->options->memory_bytes > 0 || (long)finest->width * finest->height > most_texels_of_seam ||
        weft_seam_of_material(done->material, &seam, &ignored) != WEFT_OK)
        return;
    if (seam.above_99th >= visible_share || seam.mean_difference >= visible_difference)
        weft_command_say(done->common,
                         "the material does not tile: texels across its border differ %.1f times as much as neighbours "
                         "do (`weft tile %s --blend -o TILE.weft` mends that)",
                         seam.mean_difference, done->output);
    snprintf(event, sizeof event,
             "{\"event\":\"seam\",\"pairs\":%ld,\"above_99th\":%.4g,\"strongest\":%.4g,\"mean_difference\":%.4g}",
             seam.pair_count, seam.above_99th, seam.strongest, seam.mean_difference);
    weft_command_event(done->common, event);
}

static void report_sizes(const weft_compressed *done)
{
    const weft_dataset_layout *layout = weft_dataset_get_layout(done->dataset);
    double samples = 6.0 * layout->width * layout->height * layout->image_count;
    double material = (double)weft_file_bytes(done->output);
    char share[64];
    if (material <= samples)
        snprintf(share, sizeof share, "1:%.0f", samples / fmax(material, 1));
    else /* the tables weigh more than a few small photographs */
        snprintf(share, sizeof share, "%.1f times the size", material / samples);
    weft_command_say(done->common, "%s: %.2f MB, %s of the samples as half floats (%.1f MB; the file has %.1f MB)",
                     done->output, material * 1e-6, share, samples * 1e-6, (double)weft_file_bytes(done->input) * 1e-6);
    weft_command_say(done->common, "fitted in %.1f s", done->report->seconds);
}

/* "12.3 ms a frame (81 frames/s)", or "" where nothing was drawn. */
static void print_speed(double frame_ms, char text[64])
{
    text[0] = 0;
    if (frame_ms > 0)
        snprintf(text, 64, "%.1f ms a frame (%.0f frames/s)", frame_ms, 1000 / frame_ms);
}

weft_code weft_report_prediction(const weft_common_options *common, const weft_prediction *prediction,
                                 weft_error *error)
{
    char speed[64];
    print_speed(prediction->frame_ms, speed);
    weft_command_say(common, "preset %s: %s (%s)", weft_preset_name(prediction->preset), prediction->model,
                     prediction->arguments);
    weft_command_say(common, "  predicted: %.3f MB, relative RMSE %.1f %% on directions that are not fitted%s%s",
                     prediction->bytes * 1e-6, 100 * prediction->error, speed[0] ? ", " : "", speed);
    return weft_command_report(common, "predicted", weft_prediction_to_event(prediction), error);
}

weft_code weft_report_components_for_error(const weft_common_options *common, double wished,
                                           const weft_component_count *chosen, weft_error *error)
{
    double left = chosen->held_out.material.all.relative_rmse;
    const char *about = weft_hold_out_about(&chosen->held_out);
    if (chosen->is_met)
        weft_command_say(common, "%d components: the fewest whose relative RMSE %s is at most %g %%: %.1f %%",
                         chosen->count, about, 100 * wished, 100 * left);
    else
        weft_command_say(common,
                         "no number of components has a relative RMSE of at most %g %% %s: %d come nearest, %.1f %%",
                         100 * wished, about, chosen->count, 100 * left);
    return weft_command_report(common, "chosen",
                               json_pack("{s:i, s:f, s:f, s:b}", "components", chosen->count, "wished", wished,
                                         "relative_rmse", left, "met", chosen->is_met),
                               error);
}

weft_code weft_report_components_for_budget(const weft_common_options *common, uint64_t bytes,
                                            const weft_component_count *chosen, weft_error *error)
{
    weft_command_say(common, "%d components: the most whose file has at most %g MB; predicted: %.3f MB", chosen->count,
                     1e-6 * (double)bytes, 1e-6 * chosen->bytes);
    return weft_command_report(common, "chosen",
                               json_pack("{s:i, s:I, s:f}", "components", chosen->count, "budget_bytes",
                                         (json_int_t)bytes, "predicted_bytes", chosen->bytes),
                               error);
}

/* The file is written: where it cannot be drawn, there is only nothing to say of that. */
static void report_speed(const weft_compressed *done)
{
    const weft_prediction *prediction = done->prediction;
    weft_frame_timer *timer;
    weft_error ignored;
    double frame_ms = 0;
    char predicted[64], measured[64];
    if (!(prediction->frame_ms > 0) || done->common->quiet || weft_frame_timer_open(&timer, &ignored) != WEFT_OK)
        return;
    if (weft_frame_timer_of_material(timer, done->material, &frame_ms, &ignored) != WEFT_OK)
        frame_ms = 0;
    weft_frame_timer_close(timer);
    print_speed(prediction->frame_ms, predicted);
    print_speed(frame_ms, measured);
    if (measured[0])
        weft_command_say(done->common, "predicted %s, measured %s (%+.1f %%)", predicted, measured,
                         100 * (frame_ms / prediction->frame_ms - 1));
}

static void report_prediction(const weft_compressed *done)
{
    const weft_prediction *prediction = done->prediction;
    const weft_hold_out *held_out = done->held_out;
    double bytes = (double)weft_file_bytes(done->output);
    if (!(prediction->bytes > 0))
        return;
    weft_command_say(done->common, "predicted %.3f MB, measured %.3f MB (%+.1f %%)", prediction->bytes * 1e-6,
                     bytes * 1e-6, 100 * (bytes / prediction->bytes - 1));
    if (held_out->split_count > 0 && prediction->error > 0)
        weft_command_say(done->common, "predicted relative RMSE %.1f %% %s, measured %.1f %% (%+.1f %%)",
                         100 * prediction->error, weft_hold_out_about(held_out),
                         100 * held_out->material.all.relative_rmse,
                         100 * (held_out->material.all.relative_rmse / prediction->error - 1));
    report_speed(done);
}

weft_code weft_report_compressed(const weft_compressed *done, weft_error *error)
{
    report_model(done);
    report_counts(done);
    if (done->held_out->split_count > 0)
        WEFT_TRY(report_hold_out(done->common, done->held_out, error));
    if (done->report->model == WEFT_COMPRESS_COMPONENTS)
        report_components(done->common, done->options, &done->report->components);
    else
        report_errors(done->common, done->material);
    report_ceiling(done);
    report_seam(done);
    report_sizes(done);
    report_prediction(done);
    return WEFT_OK;
}
