/* A host of a display at a Unix socket: draws a box, and reads a pixel back.
   cc -o ramtek_client examples/ramtek_client.c && ./ramtek_client /tmp/display */
#include <err.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/un.h>

enum { MOST_WORDS = 1 << 15 }; /* A packet of words has at most 64 KiB. */

/* Send one write. Its bytes are a packet, the low byte of each word first. */
static void write_words(int display, const uint16_t *words, size_t count)
{
    uint8_t packet[2 * MOST_WORDS];
    for (size_t i = 0; i < 2 * count; i++)
        packet[i] = words[i / 2] >> (i % 2 ? 8 : 0) & 0xFF;
    if (send(display, packet, 2 * count, MSG_NOSIGNAL) < 0)
        err(1, "send");
}

/* Receive one packet of replies, and return the number of words: 0 is the end. */
static size_t read_words(int display, uint16_t *words)
{
    uint8_t packet[2 * MOST_WORDS];
    ssize_t length = recv(display, packet, sizeof packet, 0);
    if (length < 0)
        err(1, "recv");
    for (ssize_t i = 0; i < length / 2; i++)
        words[i] = packet[2 * i] | packet[2 * i + 1] << 8;
    return length / 2;
}

int main(int argc, char **argv)
{
    /* LAM of entry 5, and ERS BK FORE WIN: at power-on all entries are black. */
    static const uint16_t box[] = {0x0300, 10, 4, 0x4646, 0x00EB, 0x0912, 0x0042, 5, 100, 100, 199, 149};
    static const uint16_t ask[] = {0x0B03, 0x0040, 150, 120, 150, 120, 2}; /* RI of one pixel */
    uint16_t reply[MOST_WORDS];
    struct sockaddr_un place = {.sun_family = AF_UNIX};
    int display = socket(AF_UNIX, SOCK_SEQPACKET, 0);
    strncpy(place.sun_path, argc > 1 ? argv[1] : "", sizeof place.sun_path - 1);
    if (connect(display, (struct sockaddr *)&place, sizeof place) < 0)
        err(1, "connect");
    write_words(display, box, 12);
    write_words(display, ask, 7);
    if (read_words(display, reply) != 1)
        errx(1, "the display must reply with a word");
    printf("the pixel is %u\n", reply[0]);
    shutdown(display, SHUT_WR); /* When all is executed, the display ends, too. */
    return read_words(display, reply) != 0;
}
