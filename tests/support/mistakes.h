/* Mistakes of those who attach a solver, one by each -DMISTAKE=NAME. A test includes this before column_gas.c, whose
 * calls of the wire then go through what is here; from window 50 on, but for what concerns the handshake, the mistake
 * is made. */
#define _POSIX_C_SOURCE 200809L
#include "calcine_wire.h"

#include <math.h>
#include <signal.h>
#include <string.h>

/* The mistakes. */
enum {
    components = 1, another_length, unknown_column, forgotten_column, death, nan_value, infinite_balance, another_kind,
    twice
};

static struct {
    uint64_t window, cells;
    calcine_kind kind;
    double *temperature, *balances;
} seen;

static int makes(int mistake) {
    return MISTAKE == mistake && seen.window >= 50 && seen.kind == CALCINE_FINISHED;
}

static calcine_status seen_handshake(calcine_link *link, const calcine_hello *hello, uint32_t timeout) {
    calcine_hello said = *hello;
    seen.cells = hello->count;
    if (MISTAKE == components)
        said.catalogue = "owned cell 1 u64 item\nstart void_fraction 1 1 item\nstart drag_coefficient 3 kg/s item";
    return calcine_link_handshake(link, &said, timeout);
}

static calcine_status seen_receive(calcine_link *link, uint32_t timeout, calcine_header *header, const void **payload,
                                   uint64_t *bytes) {
    calcine_status status = calcine_link_receive(link, timeout, header, payload, bytes);
    if (status == CALCINE_OK) seen.window = header->window;
    return status;
}

static calcine_status seen_loan(calcine_link *link, calcine_kind kind, uint64_t count) {
    seen.kind = kind;
    if (makes(another_kind)) return calcine_link_loan(link, CALCINE_CHECKPOINTED, count);
    return calcine_link_loan(link, kind, makes(another_length) ? count + 1 : count);
}

static calcine_status seen_column(calcine_link *link, const char *name, double **values, uint64_t *length) {
    if (makes(unknown_column) && strcmp(name, "temperature") == 0) name = "temprature";
    calcine_status status = calcine_link_loaned_column(link, name, values, length);
    if (strcmp(name, "temperature") == 0) seen.temperature = *values;
    if (strcmp(name, "balances") == 0) seen.balances = *values;
    return status;
}

static calcine_status seen_send(calcine_link *link) {
    if (makes(forgotten_column)) { /* asks for two of the ten columns only */
        double *values;
        uint64_t length;
        calcine_link_loan(link, CALCINE_FINISHED, seen.cells);
        calcine_link_loaned_column(link, "heat", &values, &length);
        calcine_link_loaned_column(link, "drag", &values, &length);
    }
    if (makes(death)) raise(SIGKILL);
    if (makes(nan_value)) seen.temperature[3] = NAN;
    if (makes(infinite_balance)) seen.balances[7] = INFINITY;
    calcine_status status = calcine_link_send(link);
    if (makes(twice)) {
        static const char *const names[] = {"heat", "drag", "temperature", "pressure", "density", "velocity",
                                            "pressure_gradient", "balances", "storage_clock", "convergence"};
        calcine_link_loan(link, CALCINE_FINISHED, seen.cells);
        for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
            double *values;
            uint64_t length;
            calcine_link_loaned_column(link, names[k], &values, &length);
            memset(values, 0, length * sizeof *values);
        }
        status = calcine_link_send(link);
    }
    return status;
}

#define calcine_link_handshake seen_handshake
#define calcine_link_receive seen_receive
#define calcine_link_loan seen_loan
#define calcine_link_loaned_column seen_column
#define calcine_link_send seen_send
