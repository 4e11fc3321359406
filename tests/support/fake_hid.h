/* A USB HID device behind the real libhidapi, without hardware: umockdev serves its hidraw node. The program must run
 * under umockdev-wrapper. */
#ifndef WEFT_TESTS_SUPPORT_FAKE_HID_H
#define WEFT_TESTS_SUPPORT_FAKE_HID_H

#include <stddef.h>
#include <umockdev.h>

typedef struct fake_hid fake_hid;

/* What the device is, and what it does with what is written to it. Its functions are called from a thread of the
 * testbed; NULL: it takes no such reports. */
typedef struct fake_hid_kind {
    unsigned short vendor, product;
    const char *maker, *name, *serial;
    const unsigned char *descriptor;
    size_t descriptor_size;
    void *context;
    /* An output report, with its number first. */
    void (*written)(void *context, fake_hid *hid, const unsigned char *bytes, size_t size);
    /* Feature reports, with their number first. */
    void (*set_feature)(void *context, const unsigned char *bytes, size_t size);
    void (*get_feature)(void *context, unsigned char *bytes, size_t size);
} fake_hid_kind;

/* Plugs it in as /dev/hidraw<number>; asserts. `kind` is borrowed. */
fake_hid *fake_hid_plug(UMockdevTestbed *testbed, int number, const fake_hid_kind *kind);
/* The same, but only the user of this process may open the node; it has no reports. */
fake_hid *fake_hid_plug_forbidden(UMockdevTestbed *testbed, int number, const fake_hid_kind *kind);
/* Queues an input report; returns once poll() sees it. Lost where the device is unplugged. */
void fake_hid_push(fake_hid *hid, const unsigned char *report, size_t size);
/* The cable is pulled: readers get an error, and it is no longer listed. */
void fake_hid_unplug(fake_hid *hid);
/* After fake_hid_unplug. */
void fake_hid_free(fake_hid *hid);

#endif
