#include "tests/capture/fake_controller.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

/* 64 bytes in, 64 bytes out, of a page of its own. */
static const unsigned char descriptor[] = {0x06, 0x00, 0xff, 0x09, 0x01, 0xa1, 0x01, 0x15, 0x00,
                                           0x26, 0xff, 0x00, 0x75, 0x08, 0x95, 0x40, 0x09, 0x02,
                                           0x81, 0x02, 0x95, 0x40, 0x09, 0x03, 0x91, 0x02, 0xc0};

static void written(void *context, fake_hid *hid, const unsigned char *bytes, size_t size)
{
    fake_controller *controller = context;
    fake_answers answers;
    if (size != 1 + WEFT_REPORT_SIZE)
        return;
    fake_stage_ask(&controller->stage, bytes + 1, &answers);
    for (int i = 0; i < answers.count; i++)
        fake_hid_push(hid, answers.report[i], WEFT_REPORT_SIZE);
}

/* Numbers are never used twice: other nodes may still be open. */
static int next_number = 10;

static void pull(fake_controller *c, fake_fault kind)
{
    fake_hid_unplug(c->hid);
    fake_hid_free(c->hid);
    c->hid = NULL;
    fake_stage_pass(&c->stage, 700); /* some of which an axis may still move */
    if (kind == FAKE_RESTARTED)
        fake_stage_restart(&c->stage);
    if (c->stays_away)
        return;
    c->number = next_number++;
    c->hid = fake_hid_plug(c->testbed, c->number, &c->kind);
    c->plugged++;
}

/* Whoever is asked by the device's own thread cannot pull its cable from there. */
static void *watch(void *argument)
{
    fake_controller *c = argument;
    pthread_mutex_lock(&c->stage.mutex);
    while (!c->ending) {
        if (!c->stage.unplug_wanted) {
            pthread_cond_wait(&c->stage.changed, &c->stage.mutex);
            continue;
        }
        c->stage.unplug_wanted = false;
        pthread_mutex_unlock(&c->stage.mutex);
        if (c->hid)
            pull(c, c->stage.unplug_kind);
        pthread_mutex_lock(&c->stage.mutex);
    }
    pthread_mutex_unlock(&c->stage.mutex);
    return NULL;
}

void fake_controller_start(fake_controller *c, UMockdevTestbed *testbed)
{
    *c = (fake_controller){.testbed = testbed, .number = next_number++};
    fake_stage_start(&c->stage);
    c->kind = (fake_hid_kind){.vendor = 0x1209,
                              .product = 0xb7f1,
                              .maker = "Weft",
                              .name = "Stage",
                              .serial = "ST-0001",
                              .descriptor = descriptor,
                              .descriptor_size = sizeof descriptor,
                              .context = c,
                              .written = written};
    c->hid = fake_hid_plug(testbed, c->number, &c->kind);
    assert_int_equal(pthread_create(&c->hand, NULL, watch, c), 0);
}

void fake_controller_end(fake_controller *c)
{
    pthread_mutex_lock(&c->stage.mutex);
    c->ending = true;
    pthread_cond_broadcast(&c->stage.changed);
    pthread_mutex_unlock(&c->stage.mutex);
    pthread_join(c->hand, NULL);
    if (c->hid) {
        fake_hid_unplug(c->hid);
        fake_hid_free(c->hid);
    }
}
