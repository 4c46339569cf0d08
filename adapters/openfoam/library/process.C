#include "process.H"
#include "meshIdentity.H"

#include "error.H"
#include "Pstream.H"
#include "stringList.H"

#include <cstdlib>
#include <iostream>
#include <new>
#include <sstream>

namespace
{

using namespace Foam;

[[noreturn]] void fail(calcine::link& link, const std::string& name, calcine_failure kind, const std::string& text)
{
    Serr<< name.c_str() << " failed: " << text.c_str() << endl;
    link.failed(kind, text);
    // Other ranks may wait for this one somewhere: MPI cannot be ended in an orderly way. And OpenFOAM's own end
    // would say that all went well (exit code 0).
    std::cout.flush();
    std::_Exit(1);
}

// OpenFOAM's message on one line, with the file of an input error.
std::string words(const error& what, const std::string& place)
{
    std::istringstream stream(what.message());
    std::string text, word;
    while (stream >> word)
    {
        text += (text.empty() ? "" : " ") + word;
    }
    return text + place;
}

} // End anonymous namespace


Foam::calcine::introduction Foam::calcine::introduce
(
    const dictionary& properties,
    const polyMesh& mesh,
    const addressing& numbers
)
{
    introduction own;
    own.version = std::to_string(OPENFOAM);
    own.caseHash = properties.get<string>("caseHash");
    own.meshHash = meshHash(mesh, numbers);
    own.cells = numbers.allCells;
    own.ranks = Pstream::nProcs();
    for (const string& column : properties.get<stringList>("catalogue"))
    {
        own.catalogue += (own.catalogue.empty() ? "" : "\n") + column;
    }
    return own;
}


int Foam::calcine::process(const std::string& name, const std::function<void(link&)>& work)
{
    FatalError.throwExceptions();
    FatalIOError.throwExceptions();
    try
    {
        calcine::link link(Pstream::myProcNo());
        try
        {
            work(link);
            return 0;
        }
        catch (const IOerror& what)
        {
            std::ostringstream place;
            place << " (" << what.ioFileName() << ", line " << what.ioStartLineNumber() << ")";
            fail(link, name, CALCINE_FAILURE_INPUT, words(what, place.str()));
        }
        catch (const error& what)
        {
            fail(link, name, CALCINE_FAILURE_OTHER, words(what, ""));
        }
        catch (const calcine::coordinatorGone&)
        {
            throw;
        }
        catch (const calcine::solverFailure& what)
        {
            fail(link, name, what.kind, what.what());
        }
        catch (const std::bad_alloc&)
        {
            fail(link, name, CALCINE_FAILURE_MEMORY, "there is too little memory");
        }
        catch (const std::exception& what)
        {
            fail(link, name, CALCINE_FAILURE_OTHER, what.what());
        }
    }
    catch (const calcine::coordinatorGone& what)
    {
        Serr<< name.c_str() << " ends: " << what.what() << endl;
    }
    catch (const std::exception& what)
    {
        Serr<< name.c_str() << " cannot reach Calcine: " << what.what() << endl;
    }
    std::_Exit(2);
}
