#include "schedule.H"
#include "error.H"

Foam::calcine::schedule::schedule(const dictionary& dict, const word& key)
:
    table_(dict.lookup(key))
{
    if (table_.empty())
    {
        FatalIOErrorInFunction(dict)
            << "the table " << key << " has no entry" << exit(FatalIOError);
    }
    for (label i = 1; i < table_.size(); ++i)
    {
        if (!(table_[i].first() > table_[i - 1].first()))
        {
            FatalIOErrorInFunction(dict)
                << "the times of the table " << key << " must increase, but "
                << table_[i].first() << " s follows " << table_[i - 1].first() << " s"
                << exit(FatalIOError);
        }
    }
}


Foam::scalar Foam::calcine::schedule::at(scalar time) const
{
    label next = 0;
    while (next < table_.size() && table_[next].first() <= time)
    {
        ++next;
    }
    if (next == 0)
    {
        return table_.first().second();
    }
    const auto& before = table_[next - 1];
    if (next == table_.size())
    {
        return before.second();
    }
    const auto& after = table_[next];
    const scalar share = (time - before.first())/(after.first() - before.first());
    return before.second() + share*(after.second() - before.second());
}
