"""Files of the program and what they hold: decks as text and by key, histories, fields, summaries and logs; how the
program is started; and single figures taken from a run, such as peak force or the extent of the damage. Every other
package may use this one; it uses none."""
