#include "tests/player/space_mouse/fake_hid.h"

#include <errno.h>
#include <fcntl.h>
#include <linux/hidraw.h>
#include <linux/input.h>
#include <poll.h>
#include <pthread.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <cmocka.h>

enum { QUEUE = 64, REPORT_SIZE = 64, VENDOR = 0x256f, PRODUCT = 0xc635 };

struct fake_hid {
    UMockdevTestbed *testbed;
    UMockdevIoctlBase *handler;
    int number, master, slave;
    pthread_mutex_t mutex;
    bool gone;
    unsigned char report[QUEUE][REPORT_SIZE];
    size_t size[QUEUE];
    int first, count;
};

/* Multi-axis controller: reports 1 and 2 of three 16-bit axes each, report 3 of two buttons. */
static const unsigned char descriptor[] = {
    0x05, 0x01, 0x09, 0x08, 0xa1, 0x01, 0xa1, 0x00, 0x85, 0x01, 0x16, 0xa2, 0xfe, 0x26, 0x5e, 0x01, 0x09, 0x30, 0x09,
    0x31, 0x09, 0x32, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xc0, 0xa1, 0x00, 0x85, 0x02, 0x09, 0x33, 0x09, 0x34, 0x09,
    0x35, 0x75, 0x10, 0x95, 0x03, 0x81, 0x06, 0xc0, 0xa1, 0x02, 0x85, 0x03, 0x05, 0x09, 0x19, 0x01, 0x29, 0x02, 0x75,
    0x01, 0x95, 0x02, 0x15, 0x00, 0x25, 0x01, 0x81, 0x02, 0x75, 0x0e, 0x95, 0x01, 0x81, 0x03, 0xc0, 0xc0};

static gboolean on_read(UMockdevIoctlBase *handler, UMockdevIoctlClient *client, gpointer data)
{
    (void)handler;
    fake_hid *hid = data;
    pthread_mutex_lock(&hid->mutex);
    if (hid->gone || hid->count == 0) {
        umockdev_ioctl_client_complete(client, -1, hid->gone ? EIO : EAGAIN);
    } else {
        UMockdevIoctlData *argument = umockdev_ioctl_client_get_arg(client);
        char token;
        size_t size = hid->size[hid->first], room = (size_t)argument->data_len;
        size = size < room ? size : room;
        umockdev_ioctl_data_update(argument, 0, hid->report[hid->first], size);
        hid->first = (hid->first + 1) % QUEUE;
        hid->count--;
        if (read(hid->slave, &token, 1) != 1)
            abort();
        umockdev_ioctl_client_complete(client, (glong)size, 0);
    }
    pthread_mutex_unlock(&hid->mutex);
    return TRUE;
}

static void answer(UMockdevIoctlData *argument, size_t offset, const void *bytes, size_t size, size_t total)
{
    UMockdevIoctlData *target = umockdev_ioctl_data_resolve(argument, 0, total, NULL);
    umockdev_ioctl_data_update(target, offset, (guint8 *)bytes, size);
    g_object_unref(target);
}

static gboolean on_ioctl(UMockdevIoctlBase *handler, UMockdevIoctlClient *client, gpointer data)
{
    (void)handler;
    (void)data;
    unsigned long request = umockdev_ioctl_client_get_request(client);
    UMockdevIoctlData *argument = umockdev_ioctl_client_get_arg(client);
    const int size = sizeof descriptor;
    const struct hidraw_devinfo info = {BUS_USB, VENDOR, (short)PRODUCT};
    if (request == HIDIOCGRDESCSIZE)
        answer(argument, 0, &size, sizeof size, sizeof size);
    else if (request == HIDIOCGRDESC)
        answer(argument, 4, descriptor, sizeof descriptor, sizeof(struct hidraw_report_descriptor));
    else if (request == HIDIOCGRAWINFO)
        answer(argument, 0, &info, sizeof info, sizeof info);
    else
        return FALSE;
    umockdev_ioctl_client_complete(client, 0, 0);
    return TRUE;
}

/* ---- Its place in the system ---- */

enum { PATH_COUNT = 4 };

/* Paths from the leaf to the root, as they must be removed. */
static void device_path(const fake_hid *hid, int index, char path[256])
{
    const char *root = "/devices/pci0000:00/usb1/1-";
    int n = hid->number;
    if (index == 0)
        snprintf(path, 256, "%s%d/1-%d:1.0/0003:%04X:%04X.000%d/hidraw/hidraw%d", root, n, n, VENDOR, PRODUCT, n, n);
    else if (index == 1)
        snprintf(path, 256, "%s%d/1-%d:1.0/0003:%04X:%04X.000%d", root, n, n, VENDOR, PRODUCT, n);
    else if (index == 2)
        snprintf(path, 256, "%s%d/1-%d:1.0", root, n, n);
    else
        snprintf(path, 256, "%s%d", root, n);
}

static void add(fake_hid *hid, int index, const char *rest)
{
    char path[256], text[2048];
    GError *error = NULL;
    device_path(hid, index, path);
    snprintf(text, sizeof text, "P: %s\n%s\n", path, rest);
    if (!umockdev_testbed_add_from_string(hid->testbed, text, &error))
        fail_msg("umockdev: %s", error->message);
}

static void add_to_system(fake_hid *hid)
{
    char text[1024], bytes[2 * sizeof descriptor + 1];
    for (size_t k = 0; k < sizeof descriptor; k++)
        sprintf(bytes + 2 * k, "%02X", descriptor[k]);
    add(hid, 3,
        "E: DEVTYPE=usb_device\nE: SUBSYSTEM=usb\nA: manufacturer=3Dconnexion\\n\nA: product=SpaceMouse Compact\\n\n"
        "A: bcdDevice=0102\\n\nA: idVendor=256f\\n\nA: idProduct=c635\\n\n");
    add(hid, 2, "E: DEVTYPE=usb_interface\nE: SUBSYSTEM=usb\nA: bInterfaceNumber=00\\n\n");
    snprintf(text, sizeof text,
             "E: DRIVER=hid-generic\nE: HID_ID=0003:0000256F:0000C635\nE: HID_NAME=3Dconnexion SpaceMouse Compact\n"
             "E: HID_PHYS=usb-0000:00:14.0-1/input0\nE: HID_UNIQ=\nE: SUBSYSTEM=hid\nH: report_descriptor=%s\n",
             bytes);
    add(hid, 1, text);
    int n = hid->number;
    snprintf(text, sizeof text,
             "N: hidraw%d\nE: DEVNAME=/dev/hidraw%d\nE: MAJOR=240\nE: MINOR=%d\nE: SUBSYSTEM=hidraw\n"
             "A: dev=240:%d\\n\nL: device=../../../0003:%04X:%04X.000%d\n",
             n, n, n, n, VENDOR, PRODUCT, n);
    add(hid, 0, text);
}

static void open_terminal(fake_hid *hid, const char *node)
{
    struct termios settings;
    hid->master = umockdev_testbed_get_dev_fd(hid->testbed, node);
    tcgetattr(hid->master, &settings);
    cfmakeraw(&settings);
    tcsetattr(hid->master, TCSANOW, &settings);
    hid->slave = open(ptsname(hid->master), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    assert_true(hid->slave >= 0);
}

static fake_hid *create(UMockdevTestbed *testbed, int number, char node[32])
{
    fake_hid *hid = calloc(1, sizeof *hid);
    assert_non_null(hid);
    snprintf(node, 32, "/dev/hidraw%d", number);
    hid->testbed = testbed;
    hid->number = number;
    pthread_mutex_init(&hid->mutex, NULL);
    add_to_system(hid);
    return hid;
}

fake_hid *fake_hid_plug(UMockdevTestbed *testbed, int number)
{
    char node[32];
    GError *error = NULL;
    fake_hid *hid = create(testbed, number, node);
    hid->handler = umockdev_ioctl_base_new();
    g_signal_connect(hid->handler, "handle-ioctl", G_CALLBACK(on_ioctl), hid);
    g_signal_connect(hid->handler, "handle-read", G_CALLBACK(on_read), hid);
    if (!umockdev_testbed_attach_ioctl(testbed, node, hid->handler, &error))
        fail_msg("umockdev: %s", error->message);
    open_terminal(hid, node);
    return hid;
}

fake_hid *fake_hid_plug_forbidden(UMockdevTestbed *testbed, int number)
{
    char node[32];
    fake_hid *hid = create(testbed, number, node);
    open_terminal(hid, node);
    assert_int_equal(fchmod(hid->slave, 0600), 0);
    return hid;
}

/* poll() is not mocked: a byte in the terminal stands for each report. */
void fake_hid_push(fake_hid *hid, const unsigned char *report, size_t size)
{
    pthread_mutex_lock(&hid->mutex);
    assert_true(hid->count < QUEUE && size <= REPORT_SIZE);
    int last = (hid->first + hid->count++) % QUEUE;
    memcpy(hid->report[last], report, size);
    hid->size[last] = size;
    assert_int_equal(write(hid->master, "T", 1), 1);
    struct pollfd arrived = {hid->slave, POLLIN, 0};
    assert_int_equal(poll(&arrived, 1, 5000), 1);
    pthread_mutex_unlock(&hid->mutex);
}

/* The master's number stays taken, by nothing, for the testbed to close. */
void fake_hid_unplug(fake_hid *hid)
{
    pthread_mutex_lock(&hid->mutex);
    hid->gone = true;
    int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    dup2(nothing, hid->master);
    close(nothing);
    pthread_mutex_unlock(&hid->mutex);
    for (int index = 0; index < PATH_COUNT; index++) {
        char path[256], full[300];
        device_path(hid, index, path);
        snprintf(full, sizeof full, "/sys%s", path);
        umockdev_testbed_uevent(hid->testbed, full, "remove");
        umockdev_testbed_remove_device(hid->testbed, full);
    }
}

/* The terminal stays open: the testbed never forgets its number and would trip over it. */
void fake_hid_free(fake_hid *hid)
{
    g_clear_object(&hid->handler);
    pthread_mutex_destroy(&hid->mutex);
    free(hid);
}
