#include "link.H"
#include "parent.H"

#include <algorithm>
#include <cstring>

namespace
{

// How long the coordinator may take over its half of the handshake, in ms.
const uint32_t handshakePatience = 10000;

// How long one wait for a request lasts, in ms. The wire looks at the coordinator in between.
const uint32_t slice = 1000;

void requireLength(const char* name, uint64_t found, uint64_t expected)
{
    if (found != expected)
    {
        throw Foam::calcine::linkError
        (
            std::string("the column ") + name + " has " + std::to_string(found)
          + " values instead of " + std::to_string(expected)
        );
    }
}

} // End anonymous namespace


void Foam::calcine::link::check(calcine_status status)
{
    switch (status)
    {
        case CALCINE_OK:
            return;
        case CALCINE_PEER_DEAD:
            throw coordinatorGone(calcine_last_error());
        case CALCINE_TIMEOUT:
            throw linkError("nothing arrived in time");
        default:
            throw linkError(calcine_last_error());
    }
}


Foam::calcine::link::link(label rank)
:
    link_(nullptr)
{
    uint32_t carried = 0;
    check(calcine_link_needs_carrier(&carried));
    calcine_carrier carrier{};
    if (carried)
    {
        parent_.reset(new parent);
        carrier = parent_->carrier();
    }
    check(calcine_link_open(static_cast<uint32_t>(rank), carried ? &carrier : nullptr, &link_));
}


Foam::calcine::link::~link()
{
    calcine_link_close(link_);
}


void Foam::calcine::link::greet(const introduction& own)
{
    const calcine_hello hello =
    {
        own.role.c_str(), own.name.c_str(), own.version.c_str(), own.caseHash.c_str(), own.meshHash.c_str(),
        own.origin.empty() ? nullptr : own.origin.c_str(), own.catalogue.c_str(), static_cast<uint64_t>(own.cells), static_cast<uint32_t>(own.ranks)
    };
    check(calcine_link_handshake(link_, &hello, handshakePatience));
}


void Foam::calcine::link::claim(const labelUList& cells)
{
    loan(CALCINE_OWNED, cells.size());
    put("cell", std::vector<uint64_t>(cells.begin(), cells.end()));
    send();
}


calcine_header Foam::calcine::link::receive()
{
    calcine_header header;
    calcine_status status;
    do
    {
        status = calcine_link_receive(link_, slice, &header, nullptr, nullptr);
    } while (status == CALCINE_TIMEOUT);
    check(status);
    return header;
}


std::string Foam::calcine::link::text() const
{
    const char* text = nullptr;
    check(calcine_link_text(link_, &text));
    return text;
}


void Foam::calcine::link::get(const char* name, scalarField& values) const
{
    const double* column = nullptr;
    uint64_t length = 0;
    check(calcine_link_column(link_, name, &column, &length));
    requireLength(name, length, values.size());
    std::copy(column, column + length, values.begin());
}


void Foam::calcine::link::get(const char* name, vectorField& values) const
{
    const double* column = nullptr;
    uint64_t length = 0;
    check(calcine_link_column(link_, name, &column, &length));
    requireLength(name, length, 3*values.size());
    forAll(values, i)
    {
        values[i] = vector(column[3*i], column[3*i + 1], column[3*i + 2]);
    }
}


void Foam::calcine::link::get(const char* name, std::vector<uint64_t>& values) const
{
    const double* column = nullptr;
    uint64_t length = 0;
    check(calcine_link_column(link_, name, &column, &length));
    requireLength(name, length, values.size());
    std::memcpy(values.data(), column, length*sizeof(uint64_t));
}


void Foam::calcine::link::loan(calcine_kind kind, label count)
{
    check(calcine_link_loan(link_, kind, static_cast<uint64_t>(count)));
}


void Foam::calcine::link::put(const char* name, const UList<scalar>& values)
{
    double* column = nullptr;
    uint64_t length = 0;
    check(calcine_link_loaned_column(link_, name, &column, &length));
    requireLength(name, length, values.size());
    std::copy(values.begin(), values.end(), column);
}


void Foam::calcine::link::put(const char* name, const UList<vector>& values)
{
    double* column = nullptr;
    uint64_t length = 0;
    check(calcine_link_loaned_column(link_, name, &column, &length));
    requireLength(name, length, 3*values.size());
    forAll(values, i)
    {
        std::copy(values[i].cdata(), values[i].cdata() + 3, column + 3*i);
    }
}


void Foam::calcine::link::put(const char* name, const std::vector<uint64_t>& values)
{
    double* column = nullptr;
    uint64_t length = 0;
    check(calcine_link_loaned_column(link_, name, &column, &length));
    requireLength(name, length, values.size());
    std::memcpy(column, values.data(), length*sizeof(uint64_t));
}


void Foam::calcine::link::send()
{
    check(calcine_link_send(link_));
}


void Foam::calcine::link::failed(calcine_failure kind, const std::string& text) noexcept
{
    calcine_link_failed(link_, kind, text.c_str());
}
