#include "windowLog.H"
#include "messageStream.H"
#include "IOstreams.H"

Foam::calcine::windowLog::windowLog(scalar every)
:
    every_(every),
    last_(clock::now())
{}


void Foam::calcine::windowLog::tell(const window& when, const report& result)
{
    const std::chrono::duration<scalar> since = clock::now() - last_;
    if (when.index >= 3 && since.count() < every_)
    {
        return;
    }
    last_ = clock::now();
    Info<< "window " << label(when.index) << " attempt " << label(when.number)
        << " process time " << when.processEnd << " s: outer " << result.outerIterations
        << ", linear " << result.linearIterations << ", residual " << result.residual
        << ", volume " << result.volumeResidual
        << ", " << result.wallTime << " s (reactions " << result.reactionTime << " s)"
        << (result.converged ? "" : ", outer loop at its limit") << endl;
}
