#include "parent.H"
#include "link.H"

#include <mpi.h>

#include <limits>

namespace
{

// Tags of messages from and to the coordinator, as in adapters/mpi.
const int down = 1, up = 2;

} // End anonymous namespace


struct Foam::calcine::parent::channel
{
    MPI_Comm comm = MPI_COMM_NULL;
    // What the coordinator has not taken, in order.
    std::deque<MPI_Request> posted;

    static int64_t post(void* context, const uint64_t* words, uint64_t count)
    {
        channel& self = *static_cast<channel*>(context);
        if (count > static_cast<uint64_t>(std::numeric_limits<int>::max()))
        {
            return -MPI_ERR_COUNT;
        }
        MPI_Request request;
        // Synchronous: it ends when the message is being taken, so that nothing piles up unseen.
        const int code =
            MPI_Issend(words, static_cast<int>(count), MPI_UINT64_T, 0, up, self.comm, &request);
        if (code == MPI_SUCCESS)
        {
            self.posted.push_back(request);
        }
        return -code;
    }

    static int64_t pending(void* context)
    {
        channel& self = *static_cast<channel*>(context);
        while (!self.posted.empty())
        {
            int done = 0;
            const int code = MPI_Test(&self.posted.front(), &done, MPI_STATUS_IGNORE);
            if (code != MPI_SUCCESS)
            {
                return -code;
            }
            if (!done)
            {
                break;
            }
            self.posted.pop_front();
        }
        return static_cast<int64_t>(self.posted.size());
    }

    static int64_t arrived(void* context)
    {
        channel& self = *static_cast<channel*>(context);
        int there = 0, count = 0;
        MPI_Status status;
        int code = MPI_Iprobe(0, down, self.comm, &there, &status);
        if (code == MPI_SUCCESS && there)
        {
            code = MPI_Get_count(&status, MPI_UINT64_T, &count);
        }
        return code == MPI_SUCCESS ? count : -code;
    }

    static int64_t take(void* context, uint64_t* words, uint64_t count)
    {
        channel& self = *static_cast<channel*>(context);
        return -MPI_Recv
        (
            words, static_cast<int>(count), MPI_UINT64_T, 0, down, self.comm, MPI_STATUS_IGNORE
        );
    }
};


Foam::calcine::parent::parent()
:
    channel_(new channel)
{
    int started = 0;
    MPI_Initialized(&started);
    if (!started)
    {
        MPI_Init(nullptr, nullptr);
    }
    MPI_Comm_get_parent(&channel_->comm);
    if (channel_->comm == MPI_COMM_NULL)
    {
        throw linkError("no coordinator has spawned this process by MPI");
    }
    MPI_Comm_set_errhandler(channel_->comm, MPI_ERRORS_RETURN);
}


Foam::calcine::parent::~parent()
{}


calcine_carrier Foam::calcine::parent::carrier()
{
    return
    {
        channel_.get(), &channel::post, &channel::pending, &channel::arrived, &channel::take
    };
}
