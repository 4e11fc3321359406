/* What `weft capture` says of a rehearsal and of a check. */
#ifndef WEFT_CLI_CAPTURE_REPORT_H
#define WEFT_CLI_CAPTURE_REPORT_H

#include "capture/capture.h"
#include "capture/preflight/preflight.h"
#include "cli/command/arguments.h"

/* `in_order`: the stage chose an order, and knows how long it takes. */
void weft_report_rehearsal(const weft_common_options *common, const weft_capture_rehearsal *rehearsal, bool in_order);

/* What several cameras would take together. Errors: those of the plan. */
weft_code weft_report_synchronised_shots(const weft_common_options *common, const weft_capture_request *request,
                                         const weft_rig *rig, weft_error *error);

/* A line for each check, or an event. Errors: WEFT_SYSTEM for memory. */
weft_code weft_report_checks(const weft_common_options *common, const weft_preflight *result, weft_error *error);

#endif
