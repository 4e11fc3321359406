/* The firmware of a stage, with motors that are not there, and the reports that it speaks. */
#include "capture/firmware/firmware.h"
#include "tests/capture/fake_stage.h"
#include "tests/support/cmocka_all.h"

#include <string.h>
#include <zlib.h>

/* ---- Reports ---- */

static void reports_come_out_as_they_went_in(void **state)
{
    (void)state;
    const weft_stage_request request = {
        WEFT_COMMAND_MOVE, 0xfedc, 0x5a, 7, 0xabcd, {-1, INT32_MIN, INT32_MAX, 0, 12345, -67890, 7, -8}};
    const weft_stage_reply reply = {.command = WEFT_COMMAND_HOME,
                                    .sequence = 0x8001,
                                    .result = WEFT_RESULT_BUSY,
                                    .state = WEFT_STATE_FAULT,
                                    .fault = WEFT_FAULT_LIMIT,
                                    .fault_axis = 3,
                                    .axis_count = 4,
                                    .homed = 0x0a,
                                    .position = {1, -2, 3, -4, INT32_MAX, INT32_MIN, 7, 8},
                                    .boot = 0xdeadbeef,
                                    .disturbances = 0x1234,
                                    .pulses = 0x5678,
                                    .level = 0x9abc,
                                    .lamp = 6};
    uint8_t report[WEFT_REPORT_SIZE];
    weft_stage_request heard;
    weft_stage_reply answered;
    weft_stage_request_pack(&request, report);
    assert_int_equal(weft_stage_request_unpack(report, &heard), WEFT_RESULT_DONE);
    assert_true(heard.command == request.command && heard.sequence == request.sequence && heard.mask == request.mask);
    assert_true(heard.number == request.number && heard.word == request.word);
    assert_memory_equal(heard.value, request.value, sizeof request.value);
    weft_stage_reply_pack(&reply, report);
    assert_int_equal(weft_stage_reply_unpack(report, &answered), WEFT_RESULT_DONE);
    assert_true(answered.command == reply.command && answered.sequence == reply.sequence);
    assert_true(answered.result == reply.result && answered.state == reply.state && answered.fault == reply.fault);
    assert_true(answered.fault_axis == reply.fault_axis && answered.axis_count == reply.axis_count);
    assert_true(answered.homed == reply.homed && answered.boot == reply.boot && answered.level == reply.level);
    assert_true(answered.disturbances == reply.disturbances && answered.pulses == reply.pulses);
    assert_int_equal(answered.lamp, reply.lamp);
    assert_memory_equal(answered.position, reply.position, sizeof reply.position);
}

/* Bytes as the reference page has them: another host must be able to rely on it. */
static void the_bytes_of_a_move_are_those_of_the_reference(void **state)
{
    (void)state;
    const weft_stage_request request = {
        .command = WEFT_COMMAND_MOVE, .sequence = 0x0102, .mask = 0x03, .value = {90000, -1500}};
    uint8_t report[WEFT_REPORT_SIZE];
    weft_stage_request_pack(&request, report);
    const uint8_t head[16] = {1, 5, 0x02, 0x01, 0x03, 0, 0, 0, 0x90, 0x5f, 0x01, 0x00, 0x24, 0xfa, 0xff, 0xff};
    assert_memory_equal(report, head, sizeof head);
    uint32_t crc = (uint32_t)crc32(0, report, 60);
    const uint8_t tail[4] = {(uint8_t)crc, (uint8_t)(crc >> 8), (uint8_t)(crc >> 16), (uint8_t)(crc >> 24)};
    assert_memory_equal(report + 60, tail, sizeof tail);
}

static void no_flipped_bit_gets_through(void **state)
{
    (void)state;
    const weft_stage_reply reply = {.command = WEFT_COMMAND_STATUS, .sequence = 5, .position = {1000, 2000}};
    uint8_t report[WEFT_REPORT_SIZE];
    weft_stage_reply answered;
    weft_stage_reply_pack(&reply, report);
    for (int bit = 0; bit < 8 * WEFT_REPORT_SIZE; bit++) {
        report[bit / 8] ^= (uint8_t)(1 << bit % 8);
        assert_int_not_equal(weft_stage_reply_unpack(report, &answered), WEFT_RESULT_DONE);
        report[bit / 8] ^= (uint8_t)(1 << bit % 8);
    }
    /* A request is no reply. */
    const weft_stage_request request = {.command = WEFT_COMMAND_STATUS, .sequence = 5};
    weft_stage_request_pack(&request, report);
    assert_int_not_equal(weft_stage_reply_unpack(report, &answered), WEFT_RESULT_DONE);
}

/* ---- The firmware ---- */

static weft_stage_reply ask(fake_stage *stage, weft_stage_request request)
{
    static uint16_t sequence = 100;
    uint8_t question[WEFT_REPORT_SIZE];
    fake_answers answers;
    weft_stage_reply reply = {0};
    if (request.sequence == 0)
        request.sequence = ++sequence;
    weft_stage_request_pack(&request, question);
    fake_stage_ask(stage, question, &answers);
    assert_int_equal(answers.count, 1);
    assert_int_equal(weft_stage_reply_unpack(answers.report[0], &reply), WEFT_RESULT_DONE);
    assert_int_equal(reply.sequence, request.sequence);
    return reply;
}

static weft_stage_reply wait_for_rest(fake_stage *stage)
{
    weft_stage_reply reply = ask(stage, (weft_stage_request){.command = WEFT_COMMAND_STATUS});
    for (int i = 0; i < 2000 && (reply.state == WEFT_STATE_MOVING || reply.state == WEFT_STATE_HOMING); i++)
        reply = ask(stage, (weft_stage_request){.command = WEFT_COMMAND_STATUS});
    return reply;
}

static void start_homed(fake_stage *stage)
{
    fake_stage_start(stage);
    assert_int_equal(ask(stage, (weft_stage_request){.command = WEFT_COMMAND_HOME, .mask = 15}).result,
                     WEFT_RESULT_DONE);
    weft_stage_reply reply = wait_for_rest(stage);
    assert_int_equal(reply.state, WEFT_STATE_IDLE);
    assert_int_equal(reply.homed, 15);
}

static weft_stage_request move_of(int axis, int32_t position)
{
    weft_stage_request request = {.command = WEFT_COMMAND_MOVE, .mask = (uint8_t)(1 << axis)};
    request.value[axis] = position;
    return request;
}

static void homed_axes_go_where_they_are_sent(void **state)
{
    (void)state;
    fake_stage stage;
    start_homed(&stage);
    weft_stage_request request = {.command = WEFT_COMMAND_MOVE, .mask = 15, .value = {45000, 350000, 10, 123456}};
    assert_int_equal(ask(&stage, request).result, WEFT_RESULT_DONE);
    weft_stage_reply reply = wait_for_rest(&stage);
    assert_int_equal(reply.state, WEFT_STATE_IDLE);
    for (int axis = 0; axis < FAKE_AXES; axis++) {
        assert_in_range(reply.position[axis] + 10 - request.value[axis], 8, 12);
        assert_float_equal(fake_stage_truth(&stage, axis), request.value[axis] * 1e-3 - fake_backlash_deg, 0.01);
    }
}

static void what_may_not_be_is_refused_whole(void **state)
{
    (void)state;
    fake_stage stage;
    fake_stage_start(&stage);
    assert_int_equal(ask(&stage, move_of(0, 0)).result, WEFT_RESULT_NOT_HOMED);
    start_homed(&stage);
    int32_t before = wait_for_rest(&stage).position[1];
    weft_stage_request request = {.command = WEFT_COMMAND_MOVE, .mask = 3, .value = {90001, 5000}};
    assert_int_equal(ask(&stage, request).result, WEFT_RESULT_BEYOND_LIMIT);
    assert_int_equal(wait_for_rest(&stage).position[1], before);
    request = (weft_stage_request){.command = WEFT_COMMAND_LIMITS, .number = 0, .value = {0, 30000}};
    assert_int_equal(ask(&stage, request).result, WEFT_RESULT_DONE);
    assert_int_equal(ask(&stage, move_of(0, 30001)).result, WEFT_RESULT_BEYOND_LIMIT);
    request.value[1] = 90001; /* wider than the machine */
    assert_int_equal(ask(&stage, request).result, WEFT_RESULT_BEYOND_LIMIT);
    assert_int_equal(ask(&stage, move_of(0, 30001)).result, WEFT_RESULT_BEYOND_LIMIT);
    assert_int_equal(ask(&stage, (weft_stage_request){.command = (weft_stage_command)99}).result,
                     WEFT_RESULT_BAD_COMMAND);
    assert_int_equal(ask(&stage, (weft_stage_request){.command = WEFT_COMMAND_MOVE, .mask = 16}).result,
                     WEFT_RESULT_BAD_COMMAND);
    request = (weft_stage_request){.command = WEFT_COMMAND_LIGHT, .number = FAKE_LAMPS, .word = 1};
    assert_int_equal(ask(&stage, request).result, WEFT_RESULT_BAD_COMMAND);
    assert_int_equal(stage.lamp, -1);
}

static void a_repeated_request_is_carried_out_once(void **state)
{
    (void)state;
    fake_stage stage;
    start_homed(&stage);
    weft_stage_request pulse = {.command = WEFT_COMMAND_SHUTTER, .sequence = 7000, .word = 100};
    for (int i = 0; i < 3; i++)
        assert_int_equal(ask(&stage, pulse).result, WEFT_RESULT_DONE);
    assert_int_equal(stage.pulses, 1);
    assert_false(stage.contact); /* 100 ms are over */
    pulse.sequence++;
    assert_int_equal(ask(&stage, pulse).pulses, 2);
    assert_int_equal(stage.pulses, 2);
    /* A host that greets begins anew, and may use the number again. */
    ask(&stage, (weft_stage_request){.command = WEFT_COMMAND_HELLO, .sequence = 6999});
    pulse.sequence = 7001;
    ask(&stage, pulse);
    assert_int_equal(stage.pulses, 3);
}

static void axes_stop_when_asked_and_when_the_host_falls_silent(void **state)
{
    (void)state;
    fake_stage stage;
    start_homed(&stage);
    ask(&stage, (weft_stage_request){.command = WEFT_COMMAND_HELLO, .word = 500});
    stage.firmware.hardware.speed[1] = 10000;
    ask(&stage, move_of(1, 300000));
    weft_stage_reply reply = ask(&stage, (weft_stage_request){.command = WEFT_COMMAND_STATUS});
    assert_int_equal(reply.state, WEFT_STATE_MOVING);
    assert_int_equal(ask(&stage, move_of(0, 10)).result, WEFT_RESULT_BUSY);
    reply = ask(&stage, (weft_stage_request){.command = WEFT_COMMAND_STOP});
    assert_int_equal(reply.state, WEFT_STATE_STOPPED);
    assert_int_equal(reply.homed, 15);
    assert_float_equal(stage.speed[1], 0, 0);
    ask(&stage, move_of(1, 300000));
    fake_stage_pass(&stage, 400);
    assert_float_equal(stage.speed[1], 10, 1e-9);
    fake_stage_pass(&stage, 200);
    assert_float_equal(stage.speed[1], 0, 0);
    assert_int_equal(ask(&stage, (weft_stage_request){.command = WEFT_COMMAND_STATUS}).state, WEFT_STATE_STOPPED);
}

static void a_stalled_axis_and_a_limit_switch_stop_all_and_cost_the_references(void **state)
{
    (void)state;
    for (int limit = 0; limit < 2; limit++) {
        fake_stage stage;
        start_homed(&stage);
        stage.firmware.hardware.speed[1] = 10000;
        weft_stage_request request = {.command = WEFT_COMMAND_MOVE, .mask = 3, .value = {80000, 300000}};
        ask(&stage, request);
        (limit ? stage.limit : stage.blocked)[1] = true;
        weft_stage_reply reply = wait_for_rest(&stage);
        assert_int_equal(reply.state, WEFT_STATE_FAULT);
        assert_int_equal(reply.fault, limit ? WEFT_FAULT_LIMIT : WEFT_FAULT_STALLED);
        assert_int_equal(reply.fault_axis, 1);
        assert_int_equal(reply.homed, 0);
        assert_float_equal(stage.speed[0], 0, 0);
        assert_float_equal(stage.speed[1], 0, 0);
        assert_int_equal(ask(&stage, move_of(0, 0)).result, WEFT_RESULT_NOT_HOMED);
    }
}

static void a_push_is_counted_also_when_the_axis_comes_back(void **state)
{
    (void)state;
    fake_stage stage;
    start_homed(&stage);
    ask(&stage, move_of(2, 20000));
    int before = wait_for_rest(&stage).disturbances;
    fake_stage_push(&stage, 2, 0.5);
    fake_stage_push(&stage, 2, -0.5);
    weft_stage_reply reply = ask(&stage, (weft_stage_request){.command = WEFT_COMMAND_STATUS});
    assert_int_equal(reply.disturbances, before + 1);
    assert_in_range(reply.position[2], 19998, 20002);
}

int test_firmware(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reports_come_out_as_they_went_in),
        cmocka_unit_test(the_bytes_of_a_move_are_those_of_the_reference),
        cmocka_unit_test(no_flipped_bit_gets_through),
        cmocka_unit_test(homed_axes_go_where_they_are_sent),
        cmocka_unit_test(what_may_not_be_is_refused_whole),
        cmocka_unit_test(a_repeated_request_is_carried_out_once),
        cmocka_unit_test(axes_stop_when_asked_and_when_the_host_falls_silent),
        cmocka_unit_test(a_stalled_axis_and_a_limit_switch_stop_all_and_cost_the_references),
        cmocka_unit_test(a_push_is_counted_also_when_the_axis_comes_back),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
