"""Files of the program: decks as text and by key, histories, fields, summaries and logs; starting the program; and
single figures of a run, such as peak force or the extent of the damage. All other packages may import this one, which
imports none of them."""
