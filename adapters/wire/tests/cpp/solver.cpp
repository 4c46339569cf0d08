// A solver of three cells: answers every start with twice the heat source, until it is told to end.
#include "calcine_wire.h"

#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <unistd.h>

static_assert(sizeof(calcine_header) == 96, "header");
static_assert(offsetof(calcine_header, window) == 32, "header");
static_assert(offsetof(calcine_header, count) == 80, "header");
static_assert(sizeof(calcine_hello) == 72, "hello");
static_assert(sizeof(calcine_status) == 4 && sizeof(calcine_kind) == 4, "enums");

static calcine_link* wire = nullptr;

static void need(calcine_status status)
{
    if (status == CALCINE_OK) return;
    std::fprintf(stderr, "status %d: %s\n", static_cast<int>(status), calcine_last_error());
    std::_Exit(10 + static_cast<int>(status));
}

static void fill(const char* name, double first)
{
    double* values = nullptr;
    uint64_t length = 0;
    need(calcine_link_loaned_column(wire, name, &values, &length));
    for (uint64_t i = 0; i < length; ++i) values[i] = first;
}

static void state(calcine_kind kind, double heat)
{
    need(calcine_link_loan(wire, kind, 3));
    fill("heat", heat);
    for (const char* name : {"drag", "temperature", "pressure", "density", "velocity",
                             "pressure_gradient", "balances", "storage_clock",
                             "convergence"})
        fill(name, 1.0);
    need(calcine_link_send(wire));
}

int main(int count, char** words)
{
    need(calcine_link_open(0, nullptr, &wire));
    const char* mesh = count > 1 ? words[1] : "mesh";
    calcine_hello hello = {"gas", "test", "1", "case", mesh, nullptr, nullptr, 3, 1};
    if (std::strcmp(mesh, "busy") == 0) {
        calcine_link_handshake(wire, &hello, 0); // nobody answers in no time
        for (;;) ::sleep(1);                     // computes without looking at its link
    }
    need(calcine_link_handshake(wire, &hello, 5000));
    state(CALCINE_STATE, 0.0);
    for (;;) {
        calcine_header header;
        const void* payload = nullptr;
        uint64_t bytes = 0;
        calcine_status status = calcine_link_receive(wire, 200, &header, &payload, &bytes);
        if (status == CALCINE_TIMEOUT) continue;
        need(status);
        if (header.kind == CALCINE_BYE) {
            need(calcine_link_loan(wire, CALCINE_BYE, 0));
            need(calcine_link_send(wire));
            calcine_link_close(wire);
            return 0;
        }
        if (header.kind == CALCINE_CHECKPOINT) {
            const char* directory = nullptr;
            need(calcine_link_text(wire, &directory));
            need(calcine_link_failed(wire, CALCINE_FAILURE_NOT_CONVERGED, directory));
            return 1;
        }
        if (header.kind == CALCINE_START) {
            const double* source = nullptr;
            uint64_t length = 0;
            need(calcine_link_column(wire, "heat_source", &source, &length));
            if (length != 3 || reinterpret_cast<uintptr_t>(source) % 64 != 0) return 2;
            state(CALCINE_FINISHED, 2.0 * source[2] + header.span_motion);
        }
    }
}
